#pragma once

#include "core/robot_layout.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::model {

/// Generalised momentum of one leg's joints, the trunk moving as it does:
///   d/dt momentum = drift + tau - friction + J' (wrench of the ground on the foot).
/// What is missing from this balance is contact; no acceleration has to be known.
struct LegMomentum {
  core::LegVector momentum;  ///< [N·m·s]
  core::LegVector drift;     ///< From gravity and from the turning of axes and origins [N·m].
};

/// @param state Pose, velocities and joints; `contact` does not matter. Real-time safe.
[[nodiscard]] LegMomentum leg_momentum(const RobotParameters& robot, core::Leg leg,
                                       const core::RobotState& state);

/// Viscous and dry friction of one leg's joints, against the motion [N·m]. Dry friction fades out
/// below a small speed. Real-time safe.
[[nodiscard]] core::LegVector joint_friction(const RobotParameters& robot,
                                             const core::LegVector& speed);

}  // namespace hopscotch::model
