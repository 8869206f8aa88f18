#pragma once

#include <Eigen/Core>

#include "core/robot_layout.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::model {

/// Parameters describe the left leg; these give those of either leg. The right leg is the mirror
/// image about the x-z plane, except that joint axes keep their direction. Real-time safe.

/// Joint origin in the parent link's frame [m].
[[nodiscard]] Eigen::Vector3d joint_origin(const RobotParameters& robot, core::Leg leg,
                                           core::Joint joint);

/// Mass properties of the link that a joint moves.
[[nodiscard]] LinkParameters leg_link(const RobotParameters& robot, core::Leg leg,
                                      core::Joint joint);

/// Sole centre F in the foot link's frame: middle of toe and heel, on the sole [m].
[[nodiscard]] Eigen::Vector3d sole_centre_in_foot(const RobotParameters& robot, core::Leg leg);

}  // namespace hopscotch::model
