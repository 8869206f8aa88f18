#pragma once

#include "apps/console.hpp"
#include "apps/live_run.hpp"
#include "apps/robot_brain.hpp"
#include "apps/robot_session.hpp"
#include "core/time.hpp"
#include "hardware/robot_plant.hpp"

namespace hopscotch::apps {

/// What `robot` tells of itself after each exchange: stages and landings as lines for people, its
/// status over LCM twenty times a second. Both leave by threads of their own; the loop gives plain
/// values away and takes nothing from the heap for it but for the answer to a command.
class RobotVoice {
 public:
  /// All outlive this object.
  RobotVoice(const RobotConfig& config, Console& console, LiveRun& live)
      : config_(config), console_(console), live_(live) {}

  /// @param brain Null before the first enabling.
  void tell(core::Stamp now, const RobotSession& session, const RobotBrain* brain);
  /// A table of all joints and what speaks against enabling, once a second.
  void tell_joints(core::Stamp now, const RobotSession& session, const hardware::RobotPlant& plant);
  /// Why the robot does not jump.
  void tell_refusal(core::Stamp now, const core::Refusal& refusal);
  /// The answer to a command of the operator.
  void tell(core::Stamp now, const core::OperatorAnswer& said);

 private:
  void tell_progress(core::Stamp now, const RobotSession& session, const RobotBrain* brain);
  void tell_status(core::Stamp now, const RobotSession& session, const RobotBrain* brain);

  const RobotConfig& config_;
  Console& console_;
  LiveRun& live_;
  core::Stamp told_;         ///< Last status.
  core::Stamp told_joints_;  ///< Last table.
  SessionStage told_stage_ = SessionStage::off;
  int told_jumps_ = 0;
};

}  // namespace hopscotch::apps
