#include "model/joint_momentum.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/sim/mujoco_robot.hpp"

namespace hopscotch::sim {
namespace {

constexpr int kTrials = 20;

/// State a moment later or earlier, with constant accelerations [a_W, alpha_B, ddq].
core::RobotState moved(const core::RobotState& state, const MujocoRobot::Velocity& acceleration,
                       double h) {
  core::RobotState later = state;
  const Eigen::Vector3d alpha_W = state.R_WB * acceleration.segment<3>(3);
  const Eigen::Vector3d turn = h * state.w_WB + 0.5 * h * h * alpha_W;
  later.R_WB = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * state.R_WB;
  later.p_WB += h * state.v_WB + 0.5 * h * h * acceleration.head<3>();
  later.v_WB += h * acceleration.head<3>();
  later.w_WB += h * alpha_W;
  later.q += h * state.dq + 0.5 * h * h * acceleration.tail<core::kJoints>();
  later.dq += h * acceleration.tail<core::kJoints>();
  return later;
}

class JointMomentumTest : public ::testing::TestWithParam<const char*> {
 protected:
  MujocoRobot mujoco_{GetParam()};
  std::mt19937 rng_{17};
};

TEST_P(JointMomentumTest, MomentumIsTheMassMatrixTimesVelocity) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const core::RobotState state = model::random_state(mujoco_.robot, rng_);
    mujoco_.place(state);
    MujocoRobot::Velocity velocity;
    velocity << state.v_WB, state.R_WB.transpose() * state.w_WB, state.dq;
    const MujocoRobot::Velocity expected = mujoco_.mass_matrix() * velocity;
    for (const core::Leg leg : core::kAllLegs) {
      const core::LegVector momentum = model::leg_momentum(mujoco_.robot, leg, state).momentum;
      const core::LegVector reference =
          expected.segment<core::kJointsPerLeg>(6 + core::leg_offset(leg));
      EXPECT_LT((momentum - reference).norm(), 1e-9);
    }
  }
}

TEST_P(JointMomentumTest, ItsDriftIsWhatMuJoCoMovesBy) {
  constexpr double kStep = 1e-5;       // [s]
  constexpr double kTolerance = 1e-5;  // of central differences at rates up to 8 rad/s [N·m]
  for (int trial = 0; trial < kTrials; ++trial) {
    const core::RobotState state = model::random_state(mujoco_.robot, rng_);
    mujoco_.place(state);  // no motor, no contact: gravity and damping only
    const MujocoRobot::Velocity acceleration = mujoco_.acceleration();
    const core::RobotState before = moved(state, acceleration, -kStep);
    const core::RobotState after = moved(state, acceleration, kStep);
    for (const core::Leg leg : core::kAllLegs) {
      const auto momentum = [&](const core::RobotState& s) {
        return model::leg_momentum(mujoco_.robot, leg, s).momentum;
      };
      const core::LegVector change = (momentum(after) - momentum(before)) / (2.0 * kStep);
      const core::LegVector damping =
          mujoco_.passive().segment<core::kJointsPerLeg>(6 + core::leg_offset(leg));
      const core::LegVector drift = model::leg_momentum(mujoco_.robot, leg, state).drift;
      EXPECT_LT((change - drift - damping).norm(), kTolerance * (1.0 + change.norm()));
    }
  }
}

TEST_P(JointMomentumTest, FrictionBrakesEachJoint) {
  core::LegVector speed;
  speed << 1.0, -2.0, 0.0, 5.0, -5.0;
  const core::LegVector friction = model::joint_friction(mujoco_.robot, speed);
  EXPECT_EQ(friction(2), 0.0);
  for (int j = 0; j < core::kJointsPerLeg; ++j) EXPECT_GE(friction(j) * speed(j), 0.0);
  const model::JointParameters& knee = mujoco_.robot.joints[core::index(core::Joint::knee)];
  EXPECT_NEAR(friction(3), 5.0 * knee.damping + knee.friction, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Robots, JointMomentumTest, ::testing::Values("hector", "hector-d14"),
                         [](const auto& robot) {
                           return std::string(robot.param) == "hector" ? "hector" : "d14";
                         });

}  // namespace
}  // namespace hopscotch::sim
