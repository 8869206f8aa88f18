#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "control/torque_law.hpp"
#include "control/wrench_mpc_problem.hpp"
#include "core/allocation_count.hpp"
#include "model/kinematics.hpp"
#include "model/motor.hpp"
#include "tests/unit/control/mpc_samples.hpp"

namespace hopscotch::control {
namespace {

class HeldWrenches : public ::testing::Test {
 protected:
  double uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }

  /// Bent knees and feet turned a little, as in a landing.
  core::RobotState landing_state() {
    core::RobotState state;
    state.p_WB = {0.3, -0.2, 0.5};
    state.R_WB = model::rotation_from_rpy({uniform(-0.1, 0.1), uniform(-0.4, 0.4), uniform(-2, 2)});
    state.v_WB.setZero();
    state.w_WB.setZero();
    for (const core::Leg leg : core::kAllLegs) {
      const double knee = uniform(-2.0, -0.6);
      state.q.segment<5>(core::leg_offset(leg)) << uniform(-0.1, 0.1), uniform(-0.1, 0.1),
          -0.5 * knee + uniform(-0.2, 0.2), knee, -0.5 * knee;
      for (int i = 0; i < 5; ++i) state.dq[core::leg_offset(leg) + i] = uniform(-12.0, 12.0);
    }
    return state;
  }

  /// Somewhere in the cone.
  FootInput input_within(double normal_max) {
    const double normal = uniform(0.0, normal_max);
    FootInput u;
    for (int i = 0; i < 4; ++i) u(i) = normal * uniform(-cone_.lower(i), cone_.upper(i));
    u(kForceZ) = normal;
    return u;
  }

  static double yaw_of(const Eigen::Isometry3d& X_WF) {
    return std::atan2(X_WF.linear()(1, 0), X_WF.linear()(0, 0));
  }

  core::ContactWrenches wrenches_of(const core::RobotState& state,
                                    const std::array<FootInput, 2>& u) const {
    const auto soles = model::sole_poses(robot_, state);
    return {foot_wrench(u[0], yaw_of(soles[0])), foot_wrench(u[1], yaw_of(soles[1]))};
  }
  std::mt19937 random_{11};
  model::RobotParameters robot_ = testing::hector();
  WrenchCone cone_ = constant_part(WrenchMpcConfig::load(testing::mpc_section()), robot_).cone;
};

TEST_F(HeldWrenches, AreTheAskedOnesToTheBitWhereTheMotorsCan) {
  for (int trial = 0; trial < 100; ++trial) {
    core::RobotState state = landing_state();
    state.dq.setZero();
    const core::JointVector base = leg_weight_torques(robot_, state);
    const core::ContactWrenches asked = wrenches_of(state, {input_within(80), input_within(80)});
    core::ContactWrenches held = asked;
    EXPECT_EQ(held_torques(robot_, state, base, held), contact_torques(robot_, state, asked));
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      EXPECT_EQ(held[leg].force, asked[leg].force);
      EXPECT_EQ(held[leg].moment, asked[leg].moment);
    }
  }
}

/// Each motor gives what it can, and the wrenches are those that its torques cause.
TEST_F(HeldWrenches, AreWhatTheMotorsCanHold) {
  int replaced = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const core::RobotState state = landing_state();
    core::JointVector base = leg_weight_torques(robot_, state);
    for (int i = 0; i < core::kJoints; ++i) base[i] += uniform(-20.0, 20.0);
    const core::ContactWrenches asked = wrenches_of(state, {input_within(500), input_within(500)});
    core::ContactWrenches held = asked;
    const core::JointVector tau = held_torques(robot_, state, base, held);
    const core::JointVector demand = base + contact_torques(robot_, state, asked);
    for (const core::Leg leg : core::kAllLegs) {
      const int first = core::leg_offset(leg);
      const core::LegVector given =
          model::saturate(robot_, demand.segment<5>(first), state.dq.segment<5>(first));
      EXPECT_LT(((base + tau).segment<5>(first) - given).cwiseAbs().maxCoeff(), 1e-5);
      replaced += held[core::index(leg)].force != asked[core::index(leg)].force ? 1 : 0;
    }
    const core::JointVector by_wrenches = contact_torques(robot_, state, held);
    EXPECT_LT((by_wrenches - tau).cwiseAbs().maxCoeff(), 0.1);  // the ridge
  }
  EXPECT_GT(replaced, 200);
}

TEST_F(HeldWrenches, AllocateNothing) {
  const core::RobotState state = landing_state();
  const core::JointVector base = leg_weight_torques(robot_, state);
  core::ContactWrenches wrenches = wrenches_of(state, {input_within(500), input_within(500)});
  wrenches[0].force.z() = 900.0;
  const std::size_t before = core::allocation_count();
  (void)held_torques(robot_, state, base, wrenches);
  EXPECT_EQ(core::allocation_count(), before);
  EXPECT_LT(wrenches[0].force.z(), 900.0);
}

}  // namespace
}  // namespace hopscotch::control
