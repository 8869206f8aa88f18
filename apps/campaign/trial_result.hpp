#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "apps/run_result.hpp"
#include "core/robot_state.hpp"

namespace hopscotch::apps::campaign {

/// What came of one trial. All but `wall` is the same whenever and wherever it is run.
struct TrialResult {
  std::int64_t index = 0;
  std::uint64_t seed = 0;
  std::string outcome;  ///< As of a run; or "crashed", "hung": the worker's end.
  std::string
      truth_outcome;     ///< Of the same seed with true terrain, where the camera's was refused.
  std::string cause;     ///< Code of the first cause; empty if nothing went wrong.
  std::string sentence;  ///< The same for people, with numbers.
  int jumps = 0;
  int landed = 0;
  double duration = core::kNaN;         ///< Simulated [s].
  double target_distance = core::kNaN;  ///< Of the last jump [m].
  double distance = core::kNaN;         ///< Flown by the last jump that came to rest [m].
  double landing_error = core::kNaN;    ///< Largest |flown - target| along the jump [m].
  double support_margin = core::kNaN;   ///< Least toe or heel margin at rest [m].
  double torque_ratio = core::kNaN;     ///< Peaks of all jumps.
  double speed_ratio = core::kNaN;
  double power_ratio = core::kNaN;
  double normal_force = core::kNaN;    ///< [N]
  double takeoff_x = core::kNaN;       ///< Of the last jump [m/s].
  double takeoff_z = core::kNaN;       ///< [m/s]
  double estimate_error = core::kNaN;  ///< Largest, of the speed at takeoff [m/s].
  double pitch_error = core::kNaN;     ///< Largest, of the trunk after a touchdown [rad].
  double jump_time = core::kNaN;       ///< Mean from a jump's start to the next one's [s].
  double jump_time_p95 = core::kNaN;   ///< [s]
  double wall = core::kNaN;            ///< Time it took [s].
  std::vector<double> values;          ///< Of the campaign's factors.
  /// Path of the CoM, x and z in W [mm], every `kPathPeriod`; empty for most trials.
  std::vector<std::array<std::int16_t, 2>> path;

  static constexpr double kPathPeriod = 0.02;  ///< [s]

  /// Completed, or rightly refused.
  [[nodiscard]] bool succeeded() const;
  [[nodiscard]] bool rightly_refused() const { return succeeded() && outcome == "refused"; }
};

/// A number of a result under the name that it has in every file.
struct Metric {
  std::string_view name;
  double TrialResult::*value;
};
inline constexpr std::array<Metric, 15> kMetrics{{
    {"duration_s", &TrialResult::duration},
    {"target_m", &TrialResult::target_distance},
    {"distance_m", &TrialResult::distance},
    {"landing_error_m", &TrialResult::landing_error},
    {"support_margin_m", &TrialResult::support_margin},
    {"torque_ratio", &TrialResult::torque_ratio},
    {"speed_ratio", &TrialResult::speed_ratio},
    {"power_ratio", &TrialResult::power_ratio},
    {"normal_force_N", &TrialResult::normal_force},
    {"takeoff_x_mps", &TrialResult::takeoff_x},
    {"takeoff_z_mps", &TrialResult::takeoff_z},
    {"estimate_error_mps", &TrialResult::estimate_error},
    {"pitch_error_rad", &TrialResult::pitch_error},
    {"jump_time_s", &TrialResult::jump_time},
    {"jump_time_p95_s", &TrialResult::jump_time_p95},
}};

/// Takes over what the run says: outcome, first cause, metrics.
void include_run(const RunResult& run, TrialResult& result);

/// The first thing that went wrong in a run: of the first jump that was not landed, else the end's.
/// @return {code, sentence}, both empty after a completed run without a missed jump.
struct Cause {
  std::string code;
  std::string sentence;
};
[[nodiscard]] Cause first_cause(const RunResult& run);

/// One line of JSON without line end, for pipes and part files.
[[nodiscard]] std::string to_line(const TrialResult& result);
/// @throws std::runtime_error if it is no such line.
[[nodiscard]] TrialResult result_from_line(std::string_view line);

}  // namespace hopscotch::apps::campaign
