#pragma once

#include "core/contact_wrenches.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// Joint torques that let the feet bear `wrenches` (ground on foot, in W) at the present posture:
/// tau = -J' u, the last term of eq. (15) with the sign that Newton's third law gives.
/// Real-time safe.
[[nodiscard]] core::JointVector contact_torques(const model::RobotParameters& robot,
                                                const core::RobotState& state,
                                                const core::ContactWrenches& wrenches) noexcept;

/// The torque rows of the MPC, kept after its QP instead of in it (docs/decisions/0151): of
/// `wrenches`, what the motors can hold at the present posture and joint speeds, each motor up to
/// its own bounds (linkage, torque-speed line, power). What they can hold is left as it is, to the
/// bit.
/// @param base             Joint torques that act whatever the feet bear: weight, joint PD [N·m].
/// @param[in,out] wrenches As in contact_torques; afterwards the nearest ones, in shares of the
///                         motors' torques, that cause the result.
/// @return joint torques for `wrenches`, next to `base`. Real-time safe.
core::JointVector held_torques(const model::RobotParameters& robot, const core::RobotState& state,
                               const core::JointVector& base,
                               core::ContactWrenches& wrenches) noexcept;

/// Joint torques that hold the legs' own weight. The single rigid body of the MPC has no legs, so
/// eq. (15) alone would let each joint sag by what hangs below it. Real-time safe.
[[nodiscard]] core::JointVector leg_weight_torques(const model::RobotParameters& robot,
                                                   const core::RobotState& state) noexcept;

}  // namespace hopscotch::control
