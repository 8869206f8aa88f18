#include "perception/body_mask.hpp"

#include "model/kinematics.hpp"

namespace hopscotch::perception {

namespace {

using core::Joint;
using core::Leg;

/// The foot is a bar from heel to toe whose lower side is the sole; its capsule lies half way up.
Capsule foot_capsule(const model::RobotParameters& robot, const Eigen::Isometry3d& X_CF) {
  const double ankle_height = -robot.sole.z();
  const double radius = 0.5 * ankle_height;
  const double half_length = 0.5 * (robot.toe + robot.heel);
  return {X_CF * Eigen::Vector3d(-half_length, 0.0, radius),
          X_CF * Eigen::Vector3d(half_length, 0.0, radius), radius};
}

}  // namespace

BodyCapsules body_in_camera(const model::RobotParameters& robot, const core::JointVector& q,
                            const Eigen::Isometry3d& X_BC) {
  const Eigen::Isometry3d X_CB = X_BC.inverse();
  BodyCapsules capsules;
  std::size_t next = 0;
  for (const Leg leg : core::kAllLegs) {
    const core::LegVector q_leg = q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
    const model::LegPoses poses = model::leg_poses(robot, leg, q_leg);
    const Eigen::Vector3d hip = X_CB * poses.X_BL[index(Joint::hip_pitch)].translation();
    const Eigen::Vector3d knee = X_CB * poses.X_BL[index(Joint::knee)].translation();
    const Eigen::Vector3d ankle = X_CB * poses.X_BL[index(Joint::ankle)].translation();
    capsules[next++] = {hip, knee, robot.thigh_radius};
    capsules[next++] = {knee, ankle, robot.shank_radius};
    capsules[next++] = foot_capsule(robot, X_CB * poses.X_BF);
  }
  return capsules;
}

}  // namespace hopscotch::perception
