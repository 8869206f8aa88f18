#include "control/torque_law.hpp"

#include <gtest/gtest.h>

#include <random>

#include "model/kinematics.hpp"
#include "tests/unit/control/mpc_samples.hpp"

namespace hopscotch::control {
namespace {

using testing::hector;

core::RobotState random_state(std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-0.4, 0.4);
  core::RobotState state;
  state.p_WB = {0.3, -0.2, 0.6};
  state.R_WB = model::rotation_from_rpy({angle(random), angle(random), angle(random)});
  state.v_WB.setZero();
  state.w_WB.setZero();
  for (int i = 0; i < core::kJoints; ++i) state.q[i] = angle(random);
  state.dq.setZero();
  return state;
}

/// Potential energy of both legs with the trunk held where it is [J].
double leg_potential(const model::RobotParameters& robot, const core::RobotState& state) {
  double energy = 0.0;
  for (const core::Leg leg : core::kAllLegs) {
    const model::LegPoses poses =
        model::leg_poses(robot, leg, state.q.segment<core::kJointsPerLeg>(core::leg_offset(leg)));
    for (std::size_t j = 0; j < core::kJointsPerLeg; ++j) {
      Eigen::Vector3d com = robot.joints[j].link.com;
      if (leg == core::Leg::right) com.y() = -com.y();
      const Eigen::Vector3d p_WC = state.p_WB + state.R_WB * (poses.X_BL[j] * com);
      energy += robot.joints[j].link.mass * 9.80665 * p_WC.z();
    }
  }
  return energy;
}

TEST(TorqueLaw, LegWeightIsTheGradientOfThePotentialEnergy) {
  const model::RobotParameters robot = hector();
  std::mt19937 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const core::RobotState state = random_state(random);
    const core::JointVector tau = leg_weight_torques(robot, state);
    for (int i = 0; i < core::kJoints; ++i) {
      const double h = 1e-5;
      core::RobotState up = state;
      core::RobotState down = state;
      up.q[i] += h;
      down.q[i] -= h;
      const double slope = (leg_potential(robot, up) - leg_potential(robot, down)) / (2.0 * h);
      EXPECT_NEAR(tau[i], slope, 1e-6) << "joint " << i;  // central differences: error ~ h^2
    }
  }
}

TEST(TorqueLaw, FeetDeliverThePowerThatTheJointsPutIn) {
  const model::RobotParameters robot = hector();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> load(-100.0, 100.0);
  for (int trial = 0; trial < 20; ++trial) {
    const core::RobotState state = random_state(random);
    core::JointVector dq;
    for (int i = 0; i < core::kJoints; ++i) dq[i] = 0.01 * load(random);
    core::ContactWrenches wrenches;
    double foot_power = 0.0;
    for (const core::Leg leg : core::kAllLegs) {
      core::Wrench& wrench = wrenches[core::index(leg)];
      wrench.force = {load(random), load(random), load(random)};
      wrench.moment = {load(random), load(random), load(random)};
      const int first = core::leg_offset(leg);
      const Eigen::Vector<double, 6> twist_B =
          model::sole_jacobian(robot, leg, state.q.segment<core::kJointsPerLeg>(first)) *
          dq.segment<core::kJointsPerLeg>(first);
      foot_power += wrench.force.dot(state.R_WB * twist_B.head<3>()) +
                    wrench.moment.dot(state.R_WB * twist_B.tail<3>());
    }
    // The ground's wrench on a foot that moves with the joints takes out what the joints put in.
    const double joint_power = contact_torques(robot, state, wrenches).dot(dq);
    EXPECT_NEAR(joint_power, -foot_power, 1e-9 * (1.0 + std::abs(foot_power)));
  }
}

TEST(TorqueLaw, NoWrenchNoTorque) {
  std::mt19937 random(9);
  EXPECT_TRUE(contact_torques(hector(), random_state(random), {}).isZero(0.0));
}

}  // namespace
}  // namespace hopscotch::control
