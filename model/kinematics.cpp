#include "model/kinematics.hpp"

#include <cmath>

#include "model/leg_mirror.hpp"

namespace hopscotch::model {

using core::Joint;
using core::Leg;

LegPoses leg_poses(const RobotParameters& robot, Leg leg, const core::LegVector& q) {
  LegPoses poses;
  Eigen::Isometry3d X_BP = Eigen::Isometry3d::Identity();  // P: parent link
  for (std::size_t i = 0; i < poses.X_BL.size(); ++i) {
    const Eigen::AngleAxisd turn(q(static_cast<Eigen::Index>(i)), robot.joints[i].axis);
    Eigen::Isometry3d X_PL = Eigen::Isometry3d::Identity();
    X_PL.translation() = joint_origin(robot, leg, static_cast<Joint>(i));
    X_PL.linear() = turn.toRotationMatrix();
    X_BP = X_BP * X_PL;
    poses.X_BL[i] = X_BP;
  }
  poses.X_BF = X_BP;
  poses.X_BF.translation() = X_BP * sole_centre_in_foot(robot, leg);
  return poses;
}

Eigen::Matrix<double, 6, core::kJointsPerLeg> sole_jacobian(const RobotParameters& robot, Leg leg,
                                                            const core::LegVector& q) {
  const LegPoses poses = leg_poses(robot, leg, q);
  Eigen::Matrix<double, 6, core::kJointsPerLeg> jacobian;
  for (std::size_t i = 0; i < poses.X_BL.size(); ++i) {
    // A joint's own rotation leaves its axis where it is, so the child's frame turns it into B.
    const Eigen::Vector3d axis_B = poses.X_BL[i].linear() * robot.joints[i].axis;
    const Eigen::Vector3d p_LF = poses.X_BF.translation() - poses.X_BL[i].translation();
    const Eigen::Index column = static_cast<Eigen::Index>(i);
    jacobian.col(column).head<3>() = axis_B.cross(p_LF);
    jacobian.col(column).tail<3>() = axis_B;
  }
  return jacobian;
}

std::array<Eigen::Isometry3d, core::kLegs> sole_poses(const RobotParameters& robot,
                                                      const core::RobotState& state) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = state.R_WB;
  X_WB.translation() = state.p_WB;
  std::array<Eigen::Isometry3d, core::kLegs> X_WF;
  for (const Leg leg : core::kAllLegs) {
    const core::LegVector q = state.q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
    X_WF[core::index(leg)] = X_WB * leg_poses(robot, leg, q).X_BF;
  }
  return X_WF;
}

SoleTips sole_tips(const RobotParameters& robot, const Eigen::Isometry3d& X_WF) {
  const double half_length = 0.5 * (robot.toe + robot.heel);
  return {X_WF * Eigen::Vector3d(half_length, 0.0, 0.0),
          X_WF * Eigen::Vector3d(-half_length, 0.0, 0.0)};
}

std::optional<core::LegVector> leg_inverse_kinematics(const RobotParameters& robot,
                                                      const Eigen::Vector3d& p_BF,
                                                      double sole_pitch) {
  Eigen::Vector3d p_BH = Eigen::Vector3d::Zero();  // H: hip-pitch axis, A: ankle axis
  for (const Joint joint : {Joint::hip_yaw, Joint::hip_roll, Joint::hip_pitch}) {
    p_BH += robot.joints[core::index(joint)].origin;
  }
  const Eigen::Matrix3d R_BF =
      Eigen::AngleAxisd(sole_pitch, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Vector3d p_BA = p_BF - R_BF * sole_centre_in_foot(robot, Leg::left);
  const Eigen::Vector3d p_AH = p_BH - p_BA;

  const double thigh = robot.thigh_length();
  const double shank = robot.shank_length();
  const double distance_squared = p_AH.x() * p_AH.x() + p_AH.z() * p_AH.z();
  const double cosine =
      (distance_squared - thigh * thigh - shank * shank) / (2.0 * thigh * shank);  // of the knee
  if (!(std::abs(cosine) <= 1.0)) return std::nullopt;  // also when a coordinate is not a number

  const double knee = -std::acos(cosine);
  const double hip = std::atan2(p_AH.x(), p_AH.z()) -
                     std::atan2(shank * std::sin(knee), thigh + shank * std::cos(knee));
  core::LegVector q;
  q << 0.0, 0.0, hip, knee, sole_pitch - hip - knee;
  return q;
}

Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))),
          std::atan2(R(1, 0), R(0, 0))};
}

Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

}  // namespace hopscotch::model
