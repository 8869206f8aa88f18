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

/// Joint torques that hold the legs' own weight. The single rigid body of the MPC has no legs, so
/// eq. (15) alone would let each joint sag by what hangs below it. Real-time safe.
[[nodiscard]] core::JointVector leg_weight_torques(const model::RobotParameters& robot,
                                                   const core::RobotState& state) noexcept;

}  // namespace hopscotch::control
