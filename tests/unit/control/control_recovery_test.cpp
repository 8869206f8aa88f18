#include <gtest/gtest.h>

#include "control/control_tick.hpp"
#include "control/torque_law.hpp"
#include "model/kinematics.hpp"
#include "tests/unit/control/control_tick_fixture.hpp"

/// What the tick does when something is not as planned.
namespace hopscotch::control {
namespace {

using core::RobotPhase;
using testing::test_config;
using ControlRecoveryTest = testing::ControlTickFixture;

TEST_F(ControlRecoveryTest, AFailedSolveLeavesTheLastGoodAnswerUntilItIsOld) {
  ControlTick control = standing();
  step(control);
  MpcAnswer good{.stamp = state_.stamp, .status = MpcStatus::solved, .form = MpcForm::full};
  good.wrenches[0].force = {0.0, 0.0, 130.0};
  control.answer(good);
  MpcAnswer failed = good;
  failed.status = MpcStatus::iteration_limit;
  failed.wrenches[0].force = {0.0, 0.0, 1e6};
  for (int i = 0; i < 20; ++i) {
    failed.stamp = state_.stamp;
    control.answer(failed);
    const core::JointCommand command = step(control);
    const core::JointVector expected =
        leg_weight_torques(robot_, state_) + contact_torques(robot_, state_, good.wrenches);
    EXPECT_NEAR((command.tau - expected).norm(), 0.0, 1e-9) << i;
    EXPECT_DOUBLE_EQ(command.kp[0], 60.0);
  }
}

TEST_F(ControlRecoveryTest, WithoutTheMpcTheJointsStiffenAndAnAnswerEndsThat) {
  ControlTick control = standing();
  step(control);
  for (int i = 0; i < 24; ++i) EXPECT_DOUBLE_EQ(step(control).kp[0], 60.0) << i;
  for (int i = 0; i < 5; ++i) step(control);
  EXPECT_DOUBLE_EQ(step(control).kp[0], 150.0);
  control.answer({.stamp = state_.stamp, .status = MpcStatus::solved, .form = MpcForm::full});
  step(control);
  EXPECT_DOUBLE_EQ(step(control).kp[0], 60.0);
}

TEST_F(ControlRecoveryTest, FeetInFlightGoWhereAPushedBodyWillNeedThem) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  run_to(control, RobotPhase::flight);
  state_.v_WB = sample_plan(plan_, control.status().plan_time).v_WG;
  const core::JointVector undisturbed = step(control).q;
  const int hip = core::joint_index(core::Leg::left, core::Joint::hip_pitch);
  const int ankle = core::joint_index(core::Leg::left, core::Joint::ankle);
  const int roll = core::joint_index(core::Leg::left, core::Joint::hip_roll);
  state_.v_WB += Eigen::Vector3d(0.05, -0.05, 0.0);  // what take-offs scatter by
  const core::JointVector scattered = step(control).q;
  EXPECT_NEAR((scattered - undisturbed).norm(), 0.0, 0.01);
  state_.v_WB += Eigen::Vector3d(0.25, -0.25, 0.0);
  const core::JointVector pushed = step(control).q;
  // About 0.2 s x 0.22 m/s further on, with legs of about half a metre.
  EXPECT_LT(pushed[hip] - undisturbed[hip], -0.05);
  EXPECT_GT(pushed[hip] - undisturbed[hip], -0.15);
  EXPECT_NEAR(pushed[hip] + pushed[ankle], undisturbed[hip] + undisturbed[ankle], 0.01);
  EXPECT_LT(pushed[roll] - undisturbed[roll], -0.05);
}

TEST_F(ControlRecoveryTest, TheRestIsPlacedOnSolesLaidFlat) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  run_to(control, RobotPhase::flight);
  for (int i = 0; i < 60; ++i) step(control);
  constexpr double kHeelStand = 0.12;  // toes up [rad]
  for (const core::Leg leg : core::kAllLegs) {
    state_.q[core::joint_index(leg, core::Joint::ankle)] -= kHeelStand;
  }
  const double heel = model::sole_tips(robot_, model::sole_poses(robot_, state_)[0]).heel.z();
  const double middle = model::sole_poses(robot_, state_)[0].translation().z();
  ASSERT_GT(middle - heel, 0.008);
  state_.contact = {true, true};
  step(control);
  EXPECT_EQ(control.phase(), RobotPhase::landing);
  const core::RobotState rest = control.rest_state();
  constexpr double kTiltOfThePlan =
      2e-4;  // its last posture does not have the soles quite level [m]
  EXPECT_NEAR(model::sole_poses(robot_, rest)[0].translation().z(), heel, kTiltOfThePlan);
}

TEST_F(ControlRecoveryTest, AJumpIsCalledOffWhenTheBodyStraysBeforeTheCommitPoint) {
  ControlConfig config = test_config();
  config.supervisor.stray_max = 0.05;
  ControlTick control(config, robot_, StandTarget{state_.q, 0.0});
  step(control);
  control.offer(plan_);
  for (int i = 0; i < 20; ++i) step(control);
  ASSERT_EQ(control.phase(), RobotPhase::crouch);
  state_.v_WB.x() = -0.4;  // about 0.2 s later the CoM would be 8 cm further back
  step(control);
  EXPECT_EQ(control.phase(), RobotPhase::landing);
  EXPECT_EQ(control.status().plan_id, 0U);
  EXPECT_FALSE(control.has_next());
  state_.v_WB.setZero();
  for (int i = 0; i < 410; ++i) step(control);
  EXPECT_EQ(control.phase(), RobotPhase::stand);
}

TEST_F(ControlRecoveryTest, ABodyThatFallsOverItsSolesIsHoppedAfter) {
  ControlConfig config = test_config();
  config.recovery_hop.excess_along = 0.01;
  ControlTick control(config, robot_, StandTarget{state_.q, 0.0});
  step(control);
  for (int i = 0; i < 100; ++i) step(control);
  ASSERT_EQ(control.phase(), RobotPhase::stand);
  state_.v_WB.x() = 0.8;
  step(control);
  ASSERT_EQ(control.phase(), RobotPhase::recover);
  const double before = model::sole_poses(robot_, state_)[0].translation().x();
  run_to(control, RobotPhase::flight);
  EXPECT_FALSE(control.wants_wrenches());
  EXPECT_GT(control.plan().target.X_WF[0].translation().x(), before + 0.1);
  for (int i = 0; i < 120; ++i) step(control);
  state_.contact = {true, true};
  state_.v_WB.setZero();
  step(control);
  EXPECT_EQ(control.phase(), RobotPhase::landing);
  for (int i = 0; i < 500; ++i) step(control);
  EXPECT_EQ(control.phase(), RobotPhase::stand);
}

TEST_F(ControlRecoveryTest, PastTheCommitPointAJumpGoesOnWhateverHappens) {
  ControlConfig config = test_config();
  config.supervisor.stray_max = 1.0;
  ControlTick control(config, robot_, StandTarget{state_.q, 0.0});
  step(control);
  control.offer(plan_);
  run_to(control, RobotPhase::takeoff);
  state_.v_WB.x() = -9.0;
  step(control);
  EXPECT_EQ(control.phase(), RobotPhase::takeoff);
}

}  // namespace
}  // namespace hopscotch::control
