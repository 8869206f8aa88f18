#include "control/torque_law.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstddef>

#include "control/wrench_mpc_problem.hpp"
#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "model/motor.hpp"

namespace hopscotch::control {

namespace {

/// Torques of the motors for these of the joints, each over what it can give [-].
core::LegVector torque_shares(const model::RobotParameters& robot, const core::LegVector& joints) {
  core::LegVector shares = model::motor_torques(joints);
  for (std::size_t i = 0; i < robot.motors.size(); ++i) {
    shares(static_cast<Eigen::Index>(i)) /= robot.motors[i].torque_max;
  }
  return shares;
}

}  // namespace

core::JointVector contact_torques(const model::RobotParameters& robot,
                                  const core::RobotState& state,
                                  const core::ContactWrenches& wrenches) noexcept {
  core::JointVector tau;
  for (const core::Leg leg : core::kAllLegs) {
    const int first = core::leg_offset(leg);
    const core::LegVector q = state.q.segment<core::kJointsPerLeg>(first);
    const core::Wrench& wrench = wrenches[core::index(leg)];
    Eigen::Vector<double, 6> wrench_B;
    wrench_B << state.R_WB.transpose() * wrench.force, state.R_WB.transpose() * wrench.moment;
    tau.segment<core::kJointsPerLeg>(first).noalias() =
        -model::sole_jacobian(robot, leg, q).transpose() * wrench_B;
  }
  return tau;
}

namespace {

/// Motor torques as shares of what each can give, per unit of a FootInput: -T^-1 M J'.
Eigen::Matrix<double, core::kJointsPerLeg, 5> share_columns(const model::RobotParameters& robot,
                                                            const core::RobotState& state,
                                                            core::Leg leg, double yaw) {
  Eigen::Matrix<double, core::kJointsPerLeg, 5> columns;
  for (int i = 0; i < 5; ++i) {
    core::ContactWrenches unit{};
    unit[core::index(leg)] = foot_wrench(FootInput::Unit(i), yaw);
    const core::JointVector tau = contact_torques(robot, state, unit);
    columns.col(i) = torque_shares(robot, tau.segment<core::kJointsPerLeg>(core::leg_offset(leg)));
  }
  return columns;
}

/// The wrench next to `wrench` whose motor torques differ by these shares.
core::Wrench changed(const model::RobotParameters& robot, const core::RobotState& state,
                     core::Leg leg, const core::LegVector& shares, const core::Wrench& wrench) {
  constexpr double kRidge = 1e-9;  // a straight knee bears any load along the leg [1/N^2]
  const Eigen::Isometry3d sole = model::sole_poses(robot, state)[core::index(leg)];
  const double yaw = std::atan2(sole.linear()(1, 0), sole.linear()(0, 0));
  const auto columns = share_columns(robot, state, leg, yaw);
  Eigen::Matrix<double, 5, 5> normal = columns.transpose() * columns;
  normal.diagonal().array() += kRidge;
  const FootInput change = normal.ldlt().solve(columns.transpose() * shares);
  return foot_wrench(foot_input(wrench, yaw) + change, yaw);
}

}  // namespace

core::JointVector held_torques(const model::RobotParameters& robot, const core::RobotState& state,
                               const core::JointVector& base,
                               core::ContactWrenches& wrenches) noexcept {
  constexpr double kSlack = 1e-6;  // [N·m]
  core::JointVector tau = contact_torques(robot, state, wrenches);
  for (const core::Leg leg : core::kAllLegs) {
    const int first = core::leg_offset(leg);
    const core::LegVector asked = (base + tau).segment<core::kJointsPerLeg>(first);
    const core::LegVector given =
        model::saturate(robot, asked, state.dq.segment<core::kJointsPerLeg>(first));
    const core::LegVector change = given - asked;
    if (change.cwiseAbs().maxCoeff() <= kSlack) continue;
    tau.segment<core::kJointsPerLeg>(first) += change;
    core::Wrench& wrench = wrenches[core::index(leg)];
    wrench = changed(robot, state, leg, torque_shares(robot, change), wrench);
  }
  return tau;
}

core::JointVector leg_weight_torques(const model::RobotParameters& robot,
                                     const core::RobotState& state) noexcept {
  const Eigen::Vector3d up_B = state.R_WB.transpose() * Eigen::Vector3d::UnitZ();
  core::JointVector tau;
  for (const core::Leg leg : core::kAllLegs) {
    const int first = core::leg_offset(leg);
    const model::LegPoses poses =
        model::leg_poses(robot, leg, state.q.segment<core::kJointsPerLeg>(first));
    double mass = 0.0;
    Eigen::Vector3d first_moment =
        Eigen::Vector3d::Zero();  // sum of m c over the links hanging below
    for (int j = core::kJointsPerLeg - 1; j >= 0; --j) {
      const auto link = static_cast<std::size_t>(j);
      const model::JointParameters& joint = robot.joints[link];
      Eigen::Vector3d com = joint.link.com;
      if (leg == core::Leg::right) com.y() = -com.y();
      mass += joint.link.mass;
      first_moment += joint.link.mass * (poses.X_BL[link] * com);
      const Eigen::Vector3d axis_B = poses.X_BL[link].linear() * joint.axis;
      const Eigen::Vector3d arm = first_moment - mass * poses.X_BL[link].translation();
      tau[first + j] = axis_B.dot(arm.cross(model::kGravity * up_B));
    }
  }
  return tau;
}

}  // namespace hopscotch::control
