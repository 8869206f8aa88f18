#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "apps/run_folder.hpp"
#include "apps/run_result.hpp"
#include "core/control_status.hpp"
#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/one_step_terrain.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "msgs/messages.hpp"

/// A run folder in memory, arranged for drawing. Times are seconds since the first record.
namespace hopscotch::apps {

/// Use of the motors of one leg at one moment, referred to the joint side of each reduction.
struct MotorUse {
  core::LegVector torque = core::LegVector::Constant(core::kNaN);  ///< [N·m]
  core::LegVector speed = core::LegVector::Constant(core::kNaN);   ///< [rad/s]
  core::LegVector power = core::LegVector::Constant(core::kNaN);   ///< + motoring [W]
};

/// One record of the plant, with what was planned for that moment.
struct Moment {
  double time = core::kNaN;  ///< [s]
  core::RobotState state;
  Eigen::Vector3d p_WG = Eigen::Vector3d::Constant(core::kNaN);  ///< Whole-body CoM [m].
  double pitch = core::kNaN;                                     ///< [rad]
  double normal_force = core::kNaN;                              ///< Vertical, both feet [N].
  double planned_pitch = core::kNaN;                             ///< [rad]
  double planned_normal_force = core::kNaN;                      ///< [N]
  std::array<MotorUse, core::kLegs> motors;
};

/// A stretch of time in one phase.
struct PhaseSpan {
  core::RobotPhase phase = core::RobotPhase::stand;
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
};

/// The instants of one jump that are worth a picture, in order; NaN when it did not come so far.
enum class Instant : std::size_t { crouch, liftoff, apex, touchdown, rest };
inline constexpr std::array<std::string_view, 5> kInstantNames{"crouch", "lift-off", "apex",
                                                               "touchdown", "rest"};

struct JumpRecord {
  int index = 0;              ///< From 1.
  std::size_t plan = 0;       ///< Place in `RunRecord::plans`; one beyond the end: none.
  double begin = core::kNaN;  ///< Of the takeoff phase [s].
  double end = core::kNaN;    ///< Of the landing phase, or of the log [s].
  std::array<double, kInstantNames.size()> instants{core::kNaN, core::kNaN, core::kNaN, core::kNaN,
                                                    core::kNaN};  ///< [s]

  [[nodiscard]] double at(Instant instant) const {
    return instants[static_cast<std::size_t>(instant)];
  }
};

/// One computation: when it ended and how long it took.
struct TimedWork {
  double time = 0.0;  ///< [s]
  double duration_ms = 0.0;
};

struct RunRecord {
  RunResult result;
  model::RobotParameters robot;
  std::optional<msgs::Scene> scene;
  core::Stamp origin;  ///< Moment of time 0.
  std::vector<Moment> moments;
  std::vector<PhaseSpan> phases;
  std::vector<JumpRecord> jumps;
  std::vector<core::JumpPlan> plans;
  std::vector<core::TargetChoice> choices;
  std::vector<core::OneStepTerrain> terrains;
  std::vector<TimedWork> planning;
  std::vector<TimedWork> balancing;  ///< MPC.
  std::vector<TimedWork> perceiving;
  std::vector<TimedWork> ticks;
  std::size_t malformed = 0;  ///< Messages that could not be read.

  [[nodiscard]] double seconds(core::Stamp stamp) const { return stamp.since(origin); }
  /// The moment nearest to a time. @pre !moments.empty()
  [[nodiscard]] const Moment& moment_at(double time) const;
  /// Nothing if the jump has none.
  [[nodiscard]] const core::JumpPlan* plan_of(const JumpRecord& jump) const;
};

/// Reads result.json, robot.yaml and run.lcm. Without HOP_TRUTH the robot's own state serves as
/// what was flown, and there are no measured forces.
/// @throws std::runtime_error, core::ConfigError naming the file.
[[nodiscard]] RunRecord load_run(const RunFolder& folder);

}  // namespace hopscotch::apps
