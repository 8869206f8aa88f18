#pragma once

#include "core/jump_plan.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::planner {

/// Adds to the certificate of a planar motion what it cannot know: a jump to the side or with a
/// turn loads the legs unequally and uses the other hip joints. Checks each leg of the lifted knots
/// against the physical limits, motors at both ends of each step; joints with a planar line tighten
/// that, the others and the share of load on the lighter foot get lines of their own.
/// @pre The certificate has room for two lines more.
void certify_legs(const model::RobotParameters& robot, double friction, core::JumpPlan& plan);

}  // namespace hopscotch::planner
