#pragma once

#include "core/jump_plan.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// The planar motion as knots of the whole robot in W: the plane stands on p_WS and looks along the
/// heading of S; legs have zero hip yaw and roll; torque and ground force are shared equally.
/// Wrench moments are about the sole centres. Writes knots, `knot_count`, times and duration of
/// `plan`.
/// @pre motion.knots fits into JumpPlan::kMaxKnots
void lift_to_3d(const PlanarModel& model, const PlanarMotion& motion,
                const core::LandingTarget& target, core::JumpPlan& plan);

}  // namespace hopscotch::planner
