#pragma once

#include "control/control_config.hpp"
#include "core/control_status.hpp"
#include "core/jump_plan.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// The phase machine:
///
/// | from    | to      | guard                                                             |
/// | ------- | ------- | ----------------------------------------------------------------- |
/// | stand   | takeoff | a next plan is at hand                                            |
/// | takeoff | flight  | the plan's lift-off time has passed                               |
/// | flight  | landing | a foot bears load after the share `touchdown_from` of the flight  |
/// | landing | stand   | the plan's duration has passed                                    |
/// | landing | takeoff | the same, with a next plan at hand                                |
/// | any     | damp    | a fault: bad value, tilt, joint range or speed, no touchdown      |
///
/// `damp` is left by nothing: the fault is latched. Real-time safe throughout.
class JumpSupervisor {
 public:
  JumpSupervisor(const SupervisorConfig& config, const model::RobotParameters& robot);

  /// The phase for this tick.
  /// @param plan      The plan being executed.
  /// @param plan_time How far the body is in it [s]; past the duration it stands.
  core::RobotPhase update(const core::RobotState& state, const core::JumpPlan& plan,
                          double plan_time) noexcept;

  /// A new plan begins: the robot leaves `stand` or `landing`. Ignored in every other phase.
  void begin_jump() noexcept;

  /// Latches a fault found by someone else, e.g. stale sensors.
  void latch(core::Reason fault) noexcept;

  [[nodiscard]] core::RobotPhase phase() const { return phase_; }
  [[nodiscard]] core::Reason fault() const { return fault_; }

 private:
  [[nodiscard]] core::Reason find_fault(const core::RobotState& state) const noexcept;

  SupervisorConfig config_;
  core::JointVector lower_;
  core::JointVector upper_;
  core::RobotPhase phase_ = core::RobotPhase::stand;
  core::Reason fault_ = core::Reason::none;
};

}  // namespace hopscotch::control
