#pragma once

#include "control/control_config.hpp"
#include "core/control_status.hpp"
#include "core/jump_plan.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// The phase machine:
///
/// | from                         | to      | guard                                           |
/// | ---------------------------- | ------- | ----------------------------------------------- |
/// | stand, landing               | crouch  | a next plan begins                              |
/// | crouch                       | takeoff | the commit point has passed                     |
/// | crouch                       | landing | the body has strayed too far from its plan      |
/// | takeoff                      | flight  | the plan's lift-off time has passed             |
/// | flight                       | landing | a foot bears load after `touchdown_from` of it  |
/// | landing                      | stand   | at rest, `rest_early` before the plan's end on  |
/// | landing                      | recover | the plan's duration has passed, not at rest     |
/// | recover                      | stand   | at rest, and no recovery hop under way          |
/// | stand, landing, recover      | recover | a recovery hop begins                           |
/// | hold                         | recover | the same; it holds again afterwards             |
/// | recover                      | flight  | a recovery hop's lift-off time has passed       |
/// | stand, recover, hold         | flight  | both feet unloaded for `fall_time`: it falls    |
/// | stand, crouch, recover       | hold    | the operator's hold                             |
/// | takeoff, flight, landing     | hold    | a hold asked for there, once stand or recover   |
/// | hold                         | stand   | the operator's release                          |
/// | all but fault                | damp    | the operator's damp                             |
/// | damp                         | stand   | the operator's release, if upright and in range |
/// | all but damp                 | fault   | bad value, tilt, joint range or speed           |
/// | flight                       | fault   | no touchdown for too long                       |
/// | all                          | fault   | a fault found by someone else                   |
/// | fault                        | damp    | the operator's clearing of the fault            |
///
/// Every other wish is refused and changes nothing. Before the commit point a jump can be called
/// off into a hold; past it only the landing can. Real-time safe throughout.
class JumpSupervisor {
 public:
  JumpSupervisor(const SupervisorConfig& config, const model::RobotParameters& robot);

  /// The phase for this tick.
  /// @param plan      The plan being executed.
  /// @param plan_time How far the body is in it [s]; past the duration it stands.
  core::RobotPhase update(const core::RobotState& state, const core::JumpPlan& plan,
                          double plan_time) noexcept;

  /// A new plan begins: the robot leaves `stand` or `landing`. Ignored in every other phase.
  /// @param plan Gives the commit point.
  void begin_jump(const core::JumpPlan& plan) noexcept;

  /// The jump cannot go on: the robot settles where it is, as after a landing. False past the
  /// commit point, where nothing is changed.
  [[nodiscard]] bool call_off() noexcept;

  /// A recovery hop begins: the robot is about to fall and jumps after its capture point. False
  /// where it is not on the ground, or on it only to leave it; nothing is changed then.
  [[nodiscard]] bool hop() noexcept;
  /// From the beginning of a recovery hop to its touchdown.
  [[nodiscard]] bool is_hopping() const { return hopping_; }

  /// The operator's wishes; false = refused in this phase.
  [[nodiscard]] bool hold() noexcept;
  /// @param state Decides whether a limp robot may get up.
  [[nodiscard]] bool release(const core::RobotState& state) noexcept;
  [[nodiscard]] bool damp() noexcept;
  [[nodiscard]] bool clear_fault() noexcept;

  /// Latches a fault found by someone else, e.g. stale sensors.
  void latch(core::Reason fault) noexcept;

  [[nodiscard]] core::RobotPhase phase() const { return phase_; }
  [[nodiscard]] core::Reason fault() const { return fault_; }

 private:
  [[nodiscard]] core::Reason find_fault(const core::RobotState& state) const noexcept;
  [[nodiscard]] bool falls(const core::RobotState& state) noexcept;
  [[nodiscard]] bool at_rest(const core::RobotState& state) const noexcept;
  void advance(const core::RobotState& state, const core::JumpPlan& plan,
               double plan_time) noexcept;

  SupervisorConfig config_;
  core::JointVector lower_;
  core::JointVector upper_;
  core::RobotPhase phase_ = core::RobotPhase::stand;
  core::Reason fault_ = core::Reason::none;
  double commit_time_ = 0.0;  ///< Of the plan being executed [s].
  bool hold_waits_ = false;   // asked for where the robot could not stop: it holds once landed
  bool hopping_ = false;
  core::Stamp loaded_;  ///< A foot bore load for the last time.
};

/// The last moment of a plan's takeoff at which its CoM rises no faster than `speed` [m/s]: until
/// then the legs can still stop the body on the ground [s].
[[nodiscard]] double commit_time(const core::JumpPlan& plan, double speed) noexcept;

}  // namespace hopscotch::control
