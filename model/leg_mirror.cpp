#include "model/leg_mirror.hpp"

namespace hopscotch::model {

namespace {

/// Reflection of a point about the x-z plane for the right leg.
Eigen::Vector3d on_side(core::Leg leg, const Eigen::Vector3d& left) {
  return leg == core::Leg::left ? left : Eigen::Vector3d(left.x(), -left.y(), left.z());
}

}  // namespace

Eigen::Vector3d joint_origin(const RobotParameters& robot, core::Leg leg, core::Joint joint) {
  return on_side(leg, robot.joints[core::index(joint)].origin);
}

LinkParameters leg_link(const RobotParameters& robot, core::Leg leg, core::Joint joint) {
  LinkParameters link = robot.joints[core::index(joint)].link;
  if (leg == core::Leg::left) return link;
  link.com = on_side(leg, link.com);
  link.inertia(0, 1) = -link.inertia(0, 1);
  link.inertia(1, 0) = -link.inertia(1, 0);
  link.inertia(1, 2) = -link.inertia(1, 2);
  link.inertia(2, 1) = -link.inertia(2, 1);
  return link;
}

Eigen::Vector3d sole_centre_in_foot(const RobotParameters& robot, core::Leg leg) {
  const Eigen::Vector3d left = robot.sole + Eigen::Vector3d(robot.sole_centre(), 0.0, 0.0);
  return on_side(leg, left);
}

}  // namespace hopscotch::model
