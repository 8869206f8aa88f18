#include "model/joint_momentum.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "model/leg_mirror.hpp"

namespace hopscotch::model {

namespace {

/// A joint with the link that it moves, everything in W.
struct MovingJoint {
  Eigen::Vector3d origin;    // [m]
  Eigen::Vector3d velocity;  // of the origin [m/s]
  Eigen::Vector3d axis;
  Eigen::Vector3d axis_rate;  // [1/s]
  double mass = 0.0;          // [kg]
  Eigen::Vector3d com;        // [m]
  Eigen::Vector3d momentum;   // linear [kg·m/s]
  Eigen::Vector3d spin;       // angular, about the link's CoM [kg·m^2/s]
};
using MovingLeg = std::array<MovingJoint, core::kJointsPerLeg>;

MovingLeg moving_leg(const RobotParameters& robot, core::Leg leg, const core::RobotState& state) {
  const int offset = core::leg_offset(leg);
  const LegPoses poses = leg_poses(robot, leg, state.q.segment<core::kJointsPerLeg>(offset));
  MovingLeg joints;
  Eigen::Vector3d p_parent = state.p_WB;
  Eigen::Vector3d v = state.v_WB;
  Eigen::Vector3d w = state.w_WB;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    MovingJoint& joint = joints[i];
    const Eigen::Matrix3d R_WL = state.R_WB * poses.X_BL[i].linear();
    joint.origin = state.p_WB + state.R_WB * poses.X_BL[i].translation();
    v += w.cross(joint.origin - p_parent);
    p_parent = joint.origin;
    joint.velocity = v;
    joint.axis = R_WL * robot.joints[i].axis;
    joint.axis_rate = w.cross(joint.axis);
    w += joint.axis * state.dq(offset + static_cast<int>(i));
    const LinkParameters link = leg_link(robot, leg, static_cast<core::Joint>(i));
    const Eigen::Vector3d arm = R_WL * link.com;
    joint.mass = link.mass;
    joint.com = joint.origin + arm;
    joint.momentum = link.mass * (v + w.cross(arm));
    joint.spin = R_WL * (link.inertia * (R_WL.transpose() * w));
  }
  return joints;
}

/// Rotors: the ankle's turns with q_knee + q_ankle.
core::LegVector rotor_momentum(const RobotParameters& robot, const core::LegVector& speed) {
  constexpr auto kKnee = static_cast<Eigen::Index>(core::Joint::knee);
  constexpr auto kAnkle = static_cast<Eigen::Index>(core::Joint::ankle);
  core::LegVector momentum;
  for (Eigen::Index j = 0; j < core::kJointsPerLeg; ++j) {
    momentum(j) = robot.motors[static_cast<std::size_t>(j)].armature * speed(j);
  }
  const double ankle = robot.motors[core::index(core::Joint::ankle)].armature;
  momentum(kAnkle) = ankle * (speed(kKnee) + speed(kAnkle));
  momentum(kKnee) += momentum(kAnkle);
  return momentum;
}

}  // namespace

LegMomentum leg_momentum(const RobotParameters& robot, core::Leg leg,
                         const core::RobotState& state) {
  const MovingLeg joints = moving_leg(robot, leg, state);
  LegMomentum result;
  result.momentum =
      rotor_momentum(robot, state.dq.segment<core::kJointsPerLeg>(core::leg_offset(leg)));
  double mass = 0.0;
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();  // of what hangs below, about W's origin
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  // about W's origin
  for (int j = core::kJointsPerLeg - 1; j >= 0; --j) {
    const MovingJoint& joint = joints[static_cast<std::size_t>(j)];
    mass += joint.mass;
    first_moment += joint.mass * joint.com;
    linear += joint.momentum;
    angular += joint.spin + joint.com.cross(joint.momentum);
    const Eigen::Vector3d about_joint = angular - joint.origin.cross(linear);
    const Eigen::Vector3d weight_arm = first_moment - mass * joint.origin;
    const Eigen::Vector3d weight_moment = weight_arm.cross(Eigen::Vector3d(0.0, 0.0, -kGravity));
    result.momentum(j) += joint.axis.dot(about_joint);
    result.drift(j) = joint.axis.dot(weight_moment - joint.velocity.cross(linear)) +
                      joint.axis_rate.dot(about_joint);
  }
  return result;
}

core::LegVector joint_friction(const RobotParameters& robot, const core::LegVector& speed) {
  constexpr double kFadeSpeed = 0.1;  // [rad/s]
  core::LegVector friction;
  for (Eigen::Index j = 0; j < core::kJointsPerLeg; ++j) {
    const JointParameters& joint = robot.joints[static_cast<std::size_t>(j)];
    friction(j) = joint.damping * speed(j) + joint.friction * std::tanh(speed(j) / kFadeSpeed);
  }
  return friction;
}

}  // namespace hopscotch::model
