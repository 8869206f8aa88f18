#include "control/control_tick.hpp"

#include <gtest/gtest.h>

#include "control/torque_law.hpp"
#include "core/allocation_count.hpp"
#include "model/kinematics.hpp"
#include "model/motor.hpp"
#include "model/rigid_body.hpp"
#include "tests/unit/control/control_tick_fixture.hpp"

namespace hopscotch::control {
namespace {

using core::RobotPhase;
using testing::kActuationDelay;
using testing::test_config;
using ControlTickTest = testing::ControlTickFixture;

TEST_F(ControlTickTest, StandsFromTheFirstTick) {
  ControlTick control = standing();
  const core::JointCommand command = step(control);
  EXPECT_EQ(command.mode, core::DriveMode::active);
  EXPECT_NEAR((command.q - state_.q).norm(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(command.kp[0], 60.0);
}

TEST_F(ControlTickTest, PlannedTorquesAreSentForTheMomentTheyAct) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  // Commands are looked up `actuation_delay` ahead of the body: at the first tick of the jump the
  // body is not yet in it, at its n-th tick the command is the plan's at n ms.
  for (int n = 0; n < 100; ++n) {
    const core::JointCommand command = step(control);
    EXPECT_NEAR((command.tau - sample_plan(plan_, 0.001 * n).tau).norm(), 0.0, 1e-9) << n;
    EXPECT_NEAR(control.status().plan_time, 0.001 * n - kActuationDelay, 1e-9);
  }
}

TEST_F(ControlTickTest, TakeoffAddsOnlyTheDeviationOfTheMpc) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  step(control);
  MpcAnswer answer{
      .stamp = state_.stamp, .status = MpcStatus::solved, .form = MpcForm::error_state};
  answer.planned[0].force = {0.0, 0.0, 70.0};
  answer.wrenches[0].force = {0.0, 0.0, 90.0};
  answer.planned[1] = answer.wrenches[1] = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  control.answer(answer);
  const core::JointCommand command = step(control);
  core::ContactWrenches deviation{};
  deviation[0].force = {0.0, 0.0, 20.0};
  const core::JointVector expected =
      sample_plan(plan_, 0.001).tau + contact_torques(robot_, state_, deviation);
  EXPECT_NEAR((command.tau - expected).norm(), 0.0, 1e-9);
}

TEST_F(ControlTickTest, StandingTorqueHoldsTheWeight) {
  ControlTick control = standing();
  step(control);
  MpcAnswer answer{.stamp = state_.stamp, .status = MpcStatus::solved, .form = MpcForm::full};
  const double weight = 9.80665 * robot_.total_mass();
  for (core::Wrench& wrench : answer.wrenches) wrench.force = {0.0, 0.0, 0.5 * weight};
  control.answer(answer);
  const core::JointCommand command = step(control);
  // Virtual work: sinking by bending the knees (feet level and in place) must cost the lost
  // potential energy of the whole robot.
  const double h = 1e-5;
  core::RobotState sunk = state_;
  sunk.q += h * (core::JointVector() << 0, 0, 1, -2, 1, 0, 0, 1, -2, 1).finished();
  const auto soles = model::sole_poses(robot_, state_);
  sunk.p_WB -= model::sole_poses(robot_, sunk)[0].translation() - soles[0].translation();
  const double drop =
      model::composite_body(robot_, state_).p_WG.z() - model::composite_body(robot_, sunk).p_WG.z();
  EXPECT_NEAR(command.tau.dot(sunk.q - state_.q), -weight * drop, 1e-4 * weight * h);
}

/// The drives get no more to do than they can, whatever the MPC asks for; the status says what of
/// it the feet are to bear.
TEST_F(ControlTickTest, ALoadThatTheMotorsCannotHoldIsTakenBack) {
  ControlTick control = standing();
  state_.q[core::joint_index(core::Leg::left, core::Joint::knee)] -= 0.1;  // the PD acts too
  step(control);
  MpcAnswer answer{.stamp = state_.stamp, .status = MpcStatus::solved, .form = MpcForm::full};
  for (core::Wrench& wrench : answer.wrenches) wrench = {{60.0, 0.0, 480.0}, {0.0, -20.0, 0.0}};
  control.answer(answer);
  const core::JointCommand command = step(control);
  const core::JointVector demand = command.tau + command.kp.cwiseProduct(command.q - state_.q) +
                                   command.kd.cwiseProduct(command.dq - state_.dq);
  for (const core::Leg leg : core::kAllLegs) {
    const core::LegVector of_leg = demand.segment<core::kJointsPerLeg>(core::leg_offset(leg));
    const core::LegVector given = model::saturate(robot_, of_leg, core::LegVector::Zero());
    EXPECT_LT((given - of_leg).cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LT(control.status().wrenches[core::index(leg)].force.z(), 480.0);
    EXPECT_GT(control.status().wrenches[core::index(leg)].force.z(), 100.0);
  }
}

TEST_F(ControlTickTest, AnswersOfAnotherPhaseOrTooOldAreNotUsed) {
  ControlTick control = standing();
  step(control);
  MpcAnswer answer{.stamp = state_.stamp, .status = MpcStatus::solved, .form = MpcForm::full};
  answer.wrenches[0].force = {0.0, 0.0, 500.0};
  control.answer(answer);
  for (int i = 0; i < 30; ++i) step(control);
  core::ContactWrenches weight{};
  for (core::Wrench& wrench : weight) wrench.force.z() = 0.5 * 9.80665 * robot_.total_mass();
  const core::JointVector planned =
      leg_weight_torques(robot_, state_) + contact_torques(robot_, state_, weight);
  EXPECT_NEAR((step(control).tau - planned).norm(), 0.0, 1e-9);
  EXPECT_GT(control.stale_ticks(), 0U);
  control.offer(plan_);
  answer.stamp = state_.stamp;
  control.answer(answer);
  EXPECT_NEAR((step(control).tau - sample_plan(plan_, 0.0).tau).norm(), 0.0, 1e-9);
}

TEST_F(ControlTickTest, TouchdownRestartsTheClockAtTheLanding) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  run_to(control, RobotPhase::flight);
  for (int i = 0; i < 60; ++i) step(control);  // 40 ms before the planned touchdown
  state_.contact = {true, false};
  step(control);
  EXPECT_EQ(control.phase(), RobotPhase::landing);
  EXPECT_TRUE(control.phase_changed());
  EXPECT_LT(control.status().plan_time, plan_.touchdown_time + 0.002);
  EXPECT_GT(control.status().plan_time, plan_.touchdown_time - 0.002);
}

TEST_F(ControlTickTest, LandingFollowsTheFeetAndRestIsThere) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  run_to(control, RobotPhase::flight);
  for (int i = 0; i < 60; ++i) step(control);
  state_.p_WB.x() += 0.37;
  state_.contact = {true, true};
  for (int i = 0; i < 200; ++i) step(control);
  const core::RobotState rest = control.rest_state();
  const auto rest_soles = model::sole_poses(robot_, rest);
  const auto soles = model::sole_poses(robot_, state_);
  const Eigen::Vector3d rest_mid =
      0.5 * (rest_soles[0].translation() + rest_soles[1].translation());
  const Eigen::Vector3d mid = 0.5 * (soles[0].translation() + soles[1].translation());
  EXPECT_NEAR((rest_mid - mid).norm(), 0.0, 1e-9);
}

TEST_F(ControlTickTest, TheRestAndTheMpcsHeadingAreThoseOfTheSoles) {
  constexpr double kTurn = 0.15;
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  run_to(control, RobotPhase::flight);
  for (int i = 0; i < 60; ++i) step(control);
  state_.R_WB = model::rotation_from_rpy({0.0, 0.0, kTurn});
  state_.contact = {true, true};
  for (int i = 0; i < 200; ++i) step(control);
  const core::RobotState rest = control.rest_state();
  const auto rest_soles = model::sole_poses(robot_, rest);
  const auto soles = model::sole_poses(robot_, state_);
  const Eigen::Vector3d rest_ahead = rest_soles[0].linear().col(0) + rest_soles[1].linear().col(0);
  const Eigen::Vector3d ahead = soles[0].linear().col(0) + soles[1].linear().col(0);
  EXPECT_NEAR(std::atan2(rest_ahead.y(), rest_ahead.x()), std::atan2(ahead.y(), ahead.x()), 1e-9);
  EXPECT_NEAR(model::rpy_from_rotation(rest.R_WB).z(), kTurn, 0.005);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    EXPECT_NEAR((rest_soles[leg].translation() - soles[leg].translation()).head<2>().norm(), 0.0,
                1e-3);
  }
  MpcQuestion question;
  question.reference.horizon = 5;
  control.question(question);
  EXPECT_NEAR(question.reference.knots[5].rpy.z(), kTurn, 0.005);
}

TEST_F(ControlTickTest, FlightKeepsTheFeetLevelWhenTheTrunkTurns) {
  const double share = test_config().gains.flight_share;
  const FlightAnswer answer = answer_to_turn(0.2);
  // The plan itself moves a little in a tick.
  EXPECT_NEAR(answer.hip, -0.2 * share, 0.02);
  EXPECT_NEAR(answer.hip + answer.ankle, -0.2, 0.01);
}

TEST_F(ControlTickTest, LegsOfAnUndisturbedFlightKeepTheirDirections) {
  const FlightAnswer answer = answer_to_turn(0.05);
  EXPECT_NEAR(answer.hip, -0.05, 0.01);
  EXPECT_NEAR(answer.ankle, 0.0, 0.01);
}

TEST_F(ControlTickTest, AWholeJumpAllocatesNothing) {
  ControlTick control = standing();
  MpcQuestion question;
  question.reference.horizon = 10;
  step(control);
  const std::size_t before = core::allocation_count();
  control.offer(plan_);
  for (int i = 0; i < 600; ++i) {
    const bool contact = control.phase() != RobotPhase::flight || i > 300;
    state_.contact = {contact, contact};
    step(control);
    control.question(question);
    control.answer({.stamp = state_.stamp, .status = MpcStatus::solved, .form = question.form});
  }
  EXPECT_EQ(core::allocation_count() - before, 0U);
  EXPECT_EQ(control.phase(), RobotPhase::stand);
}

TEST_F(ControlTickTest, SwitchedOnItGoesToTheStandFromWhereItIs) {
  ControlTick control{test_config(), robot_, StandTarget{state_.q, 0.0}};
  const core::JointVector stand = state_.q;
  for (const core::Leg leg : core::kAllLegs) {  // bent knees, soles as level as they were
    state_.q[core::joint_index(leg, core::Joint::hip_pitch)] += 0.05;
    state_.q[core::joint_index(leg, core::Joint::knee)] -= 0.10;
    state_.q[core::joint_index(leg, core::Joint::ankle)] += 0.05;
  }
  EXPECT_NEAR((step(control).q - state_.q).norm(), 0.0, 1e-9);
  core::JointVector last = state_.q;
  for (int i = 0; i < 500; ++i) {
    const core::JointVector q = step(control).q;
    EXPECT_LT((q - last).cwiseAbs().maxCoeff(), 0.001);  // no step of the set-point
    last = q;
  }
  EXPECT_NEAR((last - stand).norm(), 0.0, 1e-9);
}

TEST_F(ControlTickTest, AJumpIsCalledOffBeforeItsCommitPoint) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  for (int i = 0; i < 50; ++i) step(control);
  ASSERT_EQ(control.phase(), RobotPhase::crouch);
  EXPECT_TRUE(control.hold());
  core::JointCommand command;
  for (int i = 0; i < 1000; ++i) command = step(control);
  EXPECT_EQ(control.phase(), RobotPhase::hold);
  EXPECT_NEAR((command.q - state_.q).norm(), 0.0, 1e-9);
  control.offer(plan_);
  step(control);
  EXPECT_EQ(control.phase(), RobotPhase::hold);
  EXPECT_TRUE(control.release());
  step(control);
  EXPECT_EQ(control.phase(), RobotPhase::crouch);
}

TEST_F(ControlTickTest, AHoldInFlightWaitsForTheLandingAndDropsTheNextJump) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  run_to(control, RobotPhase::flight);
  control.offer(plan_);
  EXPECT_TRUE(control.hold());
  step(control);
  EXPECT_EQ(control.phase(), RobotPhase::flight);
  for (int i = 0; i < 60; ++i) step(control);
  state_.contact = {true, true};
  for (int i = 0; i < 500; ++i) step(control);
  EXPECT_EQ(control.phase(), RobotPhase::hold);
  EXPECT_FALSE(control.has_next());
}

TEST_F(ControlTickTest, DampedItBrakesUntilReleased) {
  ControlTick control = standing();
  step(control);
  EXPECT_TRUE(control.damp());
  EXPECT_EQ(step(control).mode, core::DriveMode::damp);
  state_.q += core::JointVector::Constant(-0.1);
  step(control);
  EXPECT_TRUE(control.release());
  const core::JointCommand command = step(control);
  EXPECT_EQ(command.mode, core::DriveMode::active);
  EXPECT_NEAR((command.q - state_.q).norm(), 0.0, 1e-4);  // one tick on its way
}

TEST_F(ControlTickTest, AFallFromAStandIsCaught) {
  ControlTick control = standing();
  step(control);
  state_.contact = {false, false};
  for (int i = 0; i < 30; ++i) step(control);
  EXPECT_EQ(control.phase(), RobotPhase::flight);
  state_.v_WB.z() = -2.0;
  state_.contact = {true, true};
  step(control);
  EXPECT_EQ(control.phase(), RobotPhase::landing);
  MpcQuestion question;
  question.reference.horizon = 10;
  control.question(question);
  EXPECT_LT(question.reference.knots[0].v_WG.z(), -1.5);  // goes on from the present motion
  EXPECT_LT(question.reference.knots[5].p_WG.z(), question.reference.knots[0].p_WG.z());
  state_.v_WB.setZero();
  for (int i = 0; i < 500; ++i) step(control);
  EXPECT_EQ(control.phase(), RobotPhase::stand);
}

TEST_F(ControlTickTest, AFallIsCaughtFromTheSpeedThatTheImpactLeaves) {
  ControlTick control = standing();
  step(control);
  state_.contact = {false, false};
  for (int i = 0; i < 30; ++i) step(control);
  state_.v_WB.z() = -2.0;
  state_.contact = {true, true};
  step(control);
  state_.v_WB.z() = -0.8;  // the feet took the rest
  for (int i = 0; i < 20; ++i) step(control);
  ASSERT_EQ(control.phase(), RobotPhase::landing);
  MpcQuestion question;
  question.reference.horizon = 10;
  control.question(question);
  EXPECT_GT(question.reference.knots[0].v_WG.z(), -0.9);
  EXPECT_LT(question.reference.knots[0].v_WG.z(), -0.5);
}

TEST_F(ControlTickTest, TheMpcIsAskedAboutTheMomentItsAnswerActs) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  for (int i = 0; i < 40; ++i) step(control);
  MpcQuestion question;
  question.reference.horizon = 10;
  control.question(question);
  const double delay = question.state.stamp.since(control.status().stamp);
  EXPECT_NEAR(delay, kActuationDelay + 0.001, 1e-9);
  constexpr double kAcceleration = 2.0;  // of the plan [m/s^2]
  EXPECT_NEAR(question.state.v_WB.x() - state_.v_WB.x(), delay * kAcceleration, 1e-9);
  EXPECT_NEAR(question.state.p_WB.x() - state_.p_WB.x(), 0.5 * delay * delay * kAcceleration, 1e-9);
  EXPECT_NEAR(question.state.dq[0] - state_.dq[0], 0.01 * delay * kAcceleration, 1e-9);
}

TEST_F(ControlTickTest, AblationsChangeWhatTheyName) {
  ControlConfig config = test_config();
  MpcQuestion question;
  question.reference.horizon = 10;
  config.ablation = core::Ablation::paper_takeoff;
  ControlTick literal{config, robot_, StandTarget{state_.q, 0.0}};
  step(literal);
  literal.offer(plan_);
  const core::JointCommand command = step(literal);
  // Not the plan's torques; before the first answer of the MPC, the plan's wrenches.
  const core::JointVector expected =
      leg_weight_torques(robot_, state_) +
      contact_torques(robot_, state_, sample_plan(plan_, 0.0).wrenches);
  EXPECT_LT((command.tau - expected).norm(), 1e-9);
  literal.question(question);
  EXPECT_EQ(question.form, MpcForm::full);

  config.ablation = core::Ablation::fixed_frequency;
  ControlTick fixed{config, robot_, StandTarget{state_.q, 0.0}};
  step(fixed);
  fixed.offer(plan_);
  step(fixed);
  fixed.question(question);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_DOUBLE_EQ(question.reference.knots[k].dt, 0.03);

  config.ablation = core::Ablation::no_landing_plan;
  ControlTick unplanned{config, robot_, StandTarget{state_.q, 0.0}};
  step(unplanned);
  unplanned.offer(plan_);
  run_to(unplanned, RobotPhase::flight);
  for (int i = 0; i < 60; ++i) step(unplanned);
  state_.contact = {true, true};
  step(unplanned);
  EXPECT_GT(unplanned.status().plan_time, plan_.duration - 0.003);
}

TEST_F(ControlTickTest, AFaultDampsAndStaysSo) {
  ControlTick control = standing();
  step(control);
  const double q = state_.q[0];
  state_.q[0] = core::kNaN;
  EXPECT_EQ(step(control).mode, core::DriveMode::damp);
  state_.q[0] = q;
  const core::JointCommand command = step(control);
  EXPECT_EQ(command.mode, core::DriveMode::damp);
  EXPECT_TRUE(command.tau.isZero(0.0));
  EXPECT_EQ(control.status().fault, core::Reason::bad_sensor_value);
  EXPECT_FALSE(control.release());
  EXPECT_TRUE(control.clear_fault());
  EXPECT_EQ(step(control).mode, core::DriveMode::damp);
  EXPECT_EQ(control.status().fault, core::Reason::none);
  EXPECT_TRUE(control.release());
  EXPECT_EQ(step(control).mode, core::DriveMode::active);
}

}  // namespace
}  // namespace hopscotch::control
