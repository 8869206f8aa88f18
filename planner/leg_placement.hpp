#pragma once

#include <Eigen/Geometry>

#include "core/jump_plan.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::planner {

/// Pose and motion that a sole is to have, in W. The roll about its own long axis is left to the
/// leg, which has no joint for it.
struct SoleMotion {
  Eigen::Isometry3d X_WF = Eigen::Isometry3d::Identity();
  Eigen::Vector3d v_WF = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d w_WF = Eigen::Vector3d::Zero();  ///< In W [rad/s].
};

/// Joint angles and rates of both legs that give the soles these motions for the trunk motion of
/// `knot`. Newton's method from the angles that `knot` holds; deterministic.
/// @return false if a sole is out of reach; `knot` is then not usable.
[[nodiscard]] bool place_legs(const model::RobotParameters& robot,
                              const std::array<SoleMotion, core::kLegs>& soles,
                              core::JumpKnot& knot);

}  // namespace hopscotch::planner
