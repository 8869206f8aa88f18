#include "model/planar_chain.hpp"

#include <Eigen/Core>
#include <initializer_list>

namespace hopscotch::model {

namespace {

using core::Joint;

/// Sagittal share of a link: CoM in the plane and inertia about the pitch axis.
struct PlanarMass {
  double mass = 0.0;                              ///< [kg]
  Eigen::Vector2d com = Eigen::Vector2d::Zero();  ///< (x, z) [m]
  double inertia = 0.0;                           ///< About the CoM [kg·m^2].
};

PlanarMass planar_mass(const LinkParameters& link, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d com = origin + link.com;
  return {link.mass, Eigen::Vector2d(com.x(), com.z()), link.inertia(1, 1)};
}

PlanarMass rigid_sum(std::initializer_list<PlanarMass> parts) {
  PlanarMass sum;
  for (const PlanarMass& part : parts) {
    sum.mass += part.mass;
    sum.com += part.mass * part.com;
  }
  sum.com /= sum.mass;
  for (const PlanarMass& part : parts) {
    sum.inertia += part.inertia + part.mass * (part.com - sum.com).squaredNorm();
  }
  return sum;
}

PlanarLink planar_link(const PlanarMass& mass, double length) {
  return {mass.mass, mass.com.x(), mass.com.y(), mass.inertia, length};
}

const JointParameters& of(const RobotParameters& robot, Joint joint) {
  return robot.joints[core::index(joint)];
}

/// A link of both legs, its CoM taken from `lower_joint`, a point in the link's frame.
PlanarMass leg_pair(const RobotParameters& robot, Joint joint, const Eigen::Vector3d& lower_joint) {
  const PlanarMass one = planar_mass(of(robot, joint).link, -lower_joint);
  return rigid_sum({one, one});
}

/// Body, hip brackets and hip motors of both sides, seen from the hip-pitch axis.
PlanarMass trunk_with_hips(const RobotParameters& robot, const Eigen::Vector3d& p_HB) {
  const Eigen::Vector3d p_H_yaw = p_HB + of(robot, Joint::hip_yaw).origin;
  const Eigen::Vector3d p_H_roll = p_H_yaw + of(robot, Joint::hip_roll).origin;
  const PlanarMass hip = planar_mass(of(robot, Joint::hip_yaw).link, p_H_yaw);
  const PlanarMass hip2 = planar_mass(of(robot, Joint::hip_roll).link, p_H_roll);
  return rigid_sum({planar_mass(robot.trunk, p_HB), hip, hip, hip2, hip2});
}

}  // namespace

PlanarChain lump_legs(const RobotParameters& robot) {
  const Eigen::Vector3d p_HB =
      -(of(robot, Joint::hip_yaw).origin + of(robot, Joint::hip_roll).origin +
        of(robot, Joint::hip_pitch).origin);
  PlanarChain chain;
  chain.foot = planar_link(leg_pair(robot, Joint::ankle, Eigen::Vector3d::Zero()), 0.0);
  chain.shank = planar_link(leg_pair(robot, Joint::knee, of(robot, Joint::ankle).origin),
                            robot.shank_length());
  chain.thigh = planar_link(leg_pair(robot, Joint::hip_pitch, of(robot, Joint::knee).origin),
                            robot.thigh_length());
  chain.trunk = planar_link(trunk_with_hips(robot, p_HB), 0.0);
  chain.trunk_x = p_HB.x();
  chain.trunk_z = p_HB.z();
  chain.sole_height = -robot.sole.z();
  chain.toe = robot.toe;
  chain.heel = robot.heel;
  chain.armature_hip = core::kLegs * robot.motors[core::index(Joint::hip_pitch)].armature;
  chain.armature_knee = core::kLegs * robot.motors[core::index(Joint::knee)].armature;
  chain.armature_ankle = core::kLegs * robot.motors[core::index(Joint::ankle)].armature;
  chain.damping_hip = core::kLegs * of(robot, Joint::hip_pitch).damping;
  chain.damping_knee = core::kLegs * of(robot, Joint::knee).damping;
  chain.damping_ankle = core::kLegs * of(robot, Joint::ankle).damping;
  return chain;
}

}  // namespace hopscotch::model
