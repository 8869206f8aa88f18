#include "control/ground_tilt.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "tests/unit/control/control_tick_fixture.hpp"

namespace hopscotch::control {
namespace {

using core::Joint;
using core::joint_index;
using core::Leg;
using core::RobotPhase;

constexpr double kSlope = 0.12;  // of ground that rises ahead: soles pitch by the negative [rad]
constexpr double kTick = 0.001;  // [s]

/// A target 0.4 m ahead on ground that rises by `slope` from 0.1 m before it on.
core::LandingTarget on_ramp(double slope) {
  core::LandingTarget target;
  target.distance = 0.4;
  for (std::size_t i = 0; i < core::TerrainProfile::kSamples; ++i) {
    const double x = core::TerrainProfile::x(static_cast<int>(i));
    target.profile.mean[i] = x > 0.3 ? std::tan(slope) * (x - 0.3) : 0.0;
  }
  return target;
}

TEST(GroundTilt, OfATargetIsTheSlopeUnderItsSoles) {
  EXPECT_NEAR(slope_ahead(on_ramp(kSlope)).along, -kSlope, 1e-9);
  EXPECT_NEAR(slope_ahead(on_ramp(-kSlope)).along, kSlope, 1e-9);
  EXPECT_EQ(slope_ahead(on_ramp(0.0)).along, 0.0);
  core::LandingTarget unknown = on_ramp(kSlope);
  unknown.profile.mean.fill(std::nan(""));
  EXPECT_EQ(slope_ahead(unknown).along, 0.0);
  EXPECT_EQ(slope_ahead({}).along, 0.0);  // nobody said where
}

class GroundTiltTest : public testing::ControlTickFixture {
 protected:
  /// The soles lie on such a slope for a time.
  void stand_on(double slope, double time) {
    core::JointVector level = state_.q;
    lay_soles(robot_, 0.0, {-slope, 0.0}, state_.q);
    for (double t = 0.0; t < time; t += kTick) tilt_.observe(robot_, state_, asked_, kTick);
    state_.q = level;
  }
  /// Both soles are to push so much [N], so far ahead of their centres [m].
  void ask(double load, double ahead) {
    for (core::Wrench& wrench : asked_) {
      wrench.force = {0.0, 0.0, load};
      wrench.moment = {0.0, -ahead * load, 0.0};
    }
  }

  void SetUp() override { ask(70.0, 0.01); }

  GroundTilt tilt_;
  core::ContactWrenches asked_;
};

TEST_F(GroundTiltTest, IsWhatSolesAtRestShow) {
  stand_on(kSlope, 0.3);
  EXPECT_NEAR(tilt_.under().along, -kSlope, 1e-3);
  stand_on(0.0, 0.3);
  EXPECT_EQ(tilt_.under().along, 0.0);
}

TEST_F(GroundTiltTest, ScatterOfLevelGroundIsNone) {
  stand_on(0.009, 0.5);
  EXPECT_EQ(tilt_.under().along, 0.0);
}

TEST_F(GroundTiltTest, ASoleThatTurnsOrHangsOrStandsOnAnEdgeShowsNothing) {
  state_.dq[joint_index(Leg::left, Joint::ankle)] = 1.0;
  stand_on(kSlope, 0.3);
  EXPECT_EQ(tilt_.under().along, 0.0);
  state_.dq.setZero();
  state_.contact = {true, false};
  stand_on(kSlope, 0.3);
  EXPECT_EQ(tilt_.under().along, 0.0);
  state_.contact = {true, true};
  stand_on(0.4, 0.3);
  EXPECT_EQ(tilt_.under().along, 0.0);
}

TEST_F(GroundTiltTest, SolesThatPushAtToeOrHeelMayHaveRisenAboutIt) {
  for (const double ahead : {0.065, -0.065}) {
    ask(70.0, ahead);
    stand_on(0.1, 0.3);
    EXPECT_EQ(tilt_.under().along, 0.0) << ahead;
  }
  ask(10.0, 0.0);  // hardly on the ground
  stand_on(0.1, 0.3);
  EXPECT_EQ(tilt_.under().along, 0.0);
  ask(70.0, 0.03);
  stand_on(0.1, 0.3);
  EXPECT_NEAR(tilt_.under().along, -0.1, 1e-3);
}

TEST_F(GroundTiltTest, LegsReachSolesThatStandAtDifferentHeightsWithAnUprightTrunk) {
  core::RobotState laid = state_;
  lay_soles(robot_, 0.0, {0.0, kSlope}, laid.q);
  const auto before = model::sole_poses(robot_, state_);
  const auto after = model::sole_poses(robot_, laid);
  const double spacing = (before[0].translation() - before[1].translation()).y();
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    const double up = (leg == 0 ? 0.5 : -0.5) * spacing * std::tan(kSlope);
    const Eigen::Vector3d moved = after[leg].translation() - before[leg].translation();
    EXPECT_NEAR((moved - Eigen::Vector3d(0.0, 0.0, up)).norm(), 0.0, 1e-4);
    EXPECT_NEAR((after[leg].linear() - before[leg].linear()).norm(), 0.0, 1e-9);
  }
  const core::RobotState level = on_level_ground(robot_, laid, {0.0, kSlope});
  EXPECT_LT((level.q - state_.q).cwiseAbs().maxCoeff(), 1e-3);
}

TEST_F(GroundTiltTest, SolesAtRestShowTheSlopeAcross) {
  const core::JointVector level = state_.q;
  lay_soles(robot_, 0.0, {0.0, -kSlope}, state_.q);
  for (double t = 0.0; t < 0.3; t += kTick) tilt_.observe(robot_, state_, asked_, kTick);
  EXPECT_NEAR(tilt_.under().across, -kSlope, 1e-3);
  EXPECT_EQ(tilt_.under().along, 0.0);
  state_.q = level;
}

TEST_F(GroundTiltTest, ATargetsSolesTellTheSlopeAcross) {
  core::LandingTarget target = on_ramp(0.0);
  target.X_WF[0].translation() = Eigen::Vector3d(0.4, 0.1, 0.012);
  target.X_WF[1].translation() = Eigen::Vector3d(0.4, -0.1, -0.012);
  EXPECT_NEAR(slope_ahead(target).across, std::atan(0.12), 1e-12);
  tilt_.begin(slope_ahead(target));
  EXPECT_EQ(tilt_.in_flight(0.0).across, 0.0);
  EXPECT_NEAR(tilt_.in_flight(1.0).across, std::atan(0.12), 1e-12);
}

TEST_F(GroundTiltTest, TurnsInFlightFromOneGroundToTheNext) {
  stand_on(kSlope, 0.3);
  tilt_.begin({0.05, 0.0});
  EXPECT_NEAR(tilt_.in_flight(0.0).along, -kSlope, 1e-3);
  EXPECT_NEAR(tilt_.in_flight(0.8).along, 0.05, 1e-12);
  tilt_.land();
  EXPECT_NEAR(tilt_.under().along, 0.05, 1e-12);
}

TEST_F(GroundTiltTest, ARobotThatStandsOnASlopeDoesNotPushItsToesIntoIt) {
  const core::JointVector level = state_.q;
  ControlTick control = standing();
  lay_soles(robot_, 0.0, {-kSlope, 0.0}, state_.q);
  core::JointCommand command;
  for (int i = 0; i < 1000; ++i) command = step(control);
  EXPECT_LT((command.q - state_.q).cwiseAbs().maxCoeff(), 0.01);
  // Nor does the jump that begins there.
  control.offer(plan_);
  command = step(control);
  ASSERT_EQ(control.phase(), RobotPhase::crouch);
  EXPECT_NEAR(command.q[joint_index(Leg::left, Joint::ankle)],
              level[joint_index(Leg::left, Joint::ankle)] - kSlope, 0.01);
  EXPECT_NEAR(command.q[joint_index(Leg::left, Joint::knee)],
              level[joint_index(Leg::left, Joint::knee)], 0.01);
}

TEST_F(GroundTiltTest, FeetComeDownOnASlopeAsItLies) {
  // Shortly before the touchdown, and after it.
  const auto ankles = [&](double slope) {
    ControlTick control = standing();
    plan_.target.distance = 0.4;
    plan_.target.profile = on_ramp(slope).profile;
    control.offer(plan_);
    state_.contact = {true, true};
    run_to(control, RobotPhase::flight);
    core::JointCommand command;
    for (int i = 0; i < 95; ++i) command = step(control);
    const double before = command.q[joint_index(Leg::right, Joint::ankle)];
    state_.contact = {true, true};
    command = step(control);
    EXPECT_EQ(control.phase(), RobotPhase::landing);
    return std::array<double, 2>{before, command.q[joint_index(Leg::right, Joint::ankle)]};
  };
  const std::array<double, 2> level = ankles(0.0);
  const std::array<double, 2> sloping = ankles(kSlope);
  EXPECT_NEAR(sloping[0] - level[0], -kSlope, 1e-9);
  EXPECT_NEAR(sloping[1] - level[1], -kSlope, 0.01);  // these soles are level, and begin to tell
}

TEST_F(GroundTiltTest, SwitchedOnOnASlopeItStandsUpWithoutAStep) {
  lay_soles(robot_, 0.0, {-kSlope, 0.0}, state_.q);
  ControlTick control = standing();
  core::JointVector last = step(control).q;
  EXPECT_LT((last - state_.q).cwiseAbs().maxCoeff(), 1e-9);
  for (int i = 0; i < 500; ++i) {
    const core::JointVector q = step(control).q;
    EXPECT_LT((q - last).cwiseAbs().maxCoeff(), 0.001);
    last = q;
  }
}

}  // namespace
}  // namespace hopscotch::control
