#pragma once

#include "core/jump_plan.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// The whole robot at one instant of the planar motion, both legs alike, in S: `p_WB` and its like
/// hold quantities in S. Efforts and times are not filled.
[[nodiscard]] core::JumpKnot straight_knot(const PlanarModel& model, const PlanarInstant& now);

/// What the ground does to each foot at its sole centre, in S [N, N·m].
[[nodiscard]] core::Wrench straight_wrench(const PlanarModel& model, const PlanarInstant& now);

/// Torques of all joints; those of both legs together are halved.
[[nodiscard]] core::JointVector straight_torques(const PlanarInstant& now);

}  // namespace hopscotch::planner
