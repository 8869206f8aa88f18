#pragma once

#include "core/jump_plan.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// A posture to stand in, both legs alike.
struct StandTarget {
  core::JointVector q;  ///< [rad]
  double pitch = 0.0;   ///< Of the trunk, + nose down [rad].
};

/// The plan that goes from how the robot is and moves now to a stand, soles where they are now: a
/// jump that is called off before its commit point, a robot that gets up or is switched on.
/// @param duration Until it stands [s]; > 0. @param[out] plan Replaced. Real-time safe.
void make_settle_plan(const model::RobotParameters& robot, const core::RobotState& state,
                      const StandTarget& target, double duration, core::JumpPlan& plan);

}  // namespace hopscotch::control
