#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/robot_state.hpp"

/// `result.json` of a run folder, schema "hopscotch.run/1". Numbers that are not known are NaN here
/// and null there.
namespace hopscotch::apps {

enum class RunOutcome : std::uint8_t { completed, refused, fell, fault, stopped };
[[nodiscard]] std::string_view run_outcome_name(RunOutcome outcome);

enum class JumpOutcome : std::uint8_t { landed, fell, missed, aborted };
[[nodiscard]] std::string_view jump_outcome_name(JumpOutcome outcome);

struct JumpResult {
  struct Target {
    double distance = core::kNaN;  ///< [m]
    double height = core::kNaN;    ///< [m]
    core::TargetSource source = core::TargetSource::perception;
  };
  struct Landing {
    double distance = core::kNaN;     ///< At rest, by the plant's truth [m].
    double height = core::kNaN;       ///< [m]
    double toe_margin = core::kNaN;   ///< Support ahead of the worse toe; negative: over [m].
    double heel_margin = core::kNaN;  ///< Behind the worse heel [m].
    /// Largest of the trunk's pitch beside the planned landing's, in the 150 ms from touchdown on,
    /// by the plant's truth [rad].
    double pitch_error = core::kNaN;
  };
  struct Plan {
    core::PlanStatus status = core::PlanStatus::bad_input;
    int iterations = 0;
    bool warm = false;
    int replanned = 0;             ///< So often what was left of the jump was planned anew.
    double duration = core::kNaN;  ///< [s]
    std::string binding_name;      ///< Tightest line of the certificate.
    double binding_margin = core::kNaN;
  };
  struct Takeoff {
    double speed_x = core::kNaN;         ///< Of the CoM at lift-off, along the jump [m/s].
    double speed_z = core::kNaN;         ///< [m/s]
    double estimate_error = core::kNaN;  ///< Of the state used, norm [m/s].
  };
  struct Peak {
    double torque_ratio = core::kNaN;
    double speed_ratio = core::kNaN;
    double power_ratio = core::kNaN;
    double normal_force = core::kNaN;  ///< Both feet [N].
  };

  int index = 0;  ///< From 1.
  JumpOutcome outcome = JumpOutcome::aborted;
  std::string reason;         ///< "code: sentence" or empty.
  double start = core::kNaN;  ///< When its push-off began [s].
  Target target;
  Landing landing;
  Plan plan;
  Takeoff takeoff;
  double flight = core::kNaN;  ///< [s]
  Peak peak;
};

/// Of many measured times [ms].
struct Percentiles {
  double p50 = core::kNaN;
  double p99 = core::kNaN;
  double max = core::kNaN;

  /// By nearest rank; NaN without samples.
  static Percentiles of(std::vector<double> samples);
};

/// The only part that may differ between equal runs.
struct RunTiming {
  Percentiles plan_ms;
  Percentiles replan_ms;
  Percentiles mpc_ms;
  Percentiles perception_ms;
  Percentiles estimator_ms;
  Percentiles tick_ms;
  int deadline_misses = 0;
  double real_time_factor = core::kNaN;
};

struct RunResult {
  static constexpr std::string_view kSchema = "hopscotch.run/1";

  std::string run_id;
  std::string scenario;
  std::uint64_t seed = 0;
  std::string program;     ///< Version or git hash.
  std::string perception;  ///< camera, truth
  std::string state;       ///< estimate, truth
  RunOutcome outcome = RunOutcome::stopped;
  std::string reason;            ///< "code: sentence" or empty.
  double duration = core::kNaN;  ///< Simulated [s].
  std::vector<JumpResult> jumps;
  int falls = 0;
  double position_error = core::kNaN;  ///< Of the state used, largest [m].
  double pitch_error = core::kNaN;     ///< [rad]
  RunTiming timing;
};

/// From the start of a jump that was landed to the start of the next.
struct JumpTimes {
  double mean = core::kNaN;  ///< [s]
  double p95 = core::kNaN;   ///< By nearest rank [s].
  int count = 0;
};
[[nodiscard]] JumpTimes jump_times(const std::vector<JumpResult>& jumps);

/// Indented JSON in the order of the contract, numbers rounded to 1e-6, newline at the end.
[[nodiscard]] std::string to_json(const RunResult& result);

/// @param name Stands for the source in messages.
/// @throws core::ConfigError naming the source, the key, its value and the rule.
[[nodiscard]] RunResult run_result_from_json(std::string_view text, const std::string& name);

/// Writes beside the file first and renames, so that it is whole or not there.
/// @throws std::runtime_error if the disk refuses.
void write_run_result(const std::filesystem::path& file, const RunResult& result);

/// @throws core::ConfigError naming the file, the key, its value and the rule; std::runtime_error
/// if
///         it cannot be read.
[[nodiscard]] RunResult read_run_result(const std::filesystem::path& file);

}  // namespace hopscotch::apps
