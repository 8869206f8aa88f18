#pragma once

#include "core/jump_plan.hpp"
#include "core/robot_state.hpp"
#include "model/kinematics.hpp"

namespace hopscotch::model {

/// The robot as a plan has it at a knot; stamp and contacts are left as they are by default.
[[nodiscard]] inline core::RobotState state_of(const core::JumpKnot& knot) {
  core::RobotState state;
  state.p_WB = knot.p_WB;
  state.R_WB = rotation_from_rpy(knot.rpy);
  state.v_WB = knot.v_WB;
  state.w_WB = knot.w_WB;
  state.q = knot.q;
  state.dq = knot.dq;
  return state;
}

}  // namespace hopscotch::model
