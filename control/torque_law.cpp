#include "control/torque_law.hpp"

#include "model/gravity.hpp"
#include "model/kinematics.hpp"

namespace hopscotch::control {

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
