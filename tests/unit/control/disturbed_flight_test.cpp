#include "control/disturbed_flight.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "control/plan_follower.hpp"
#include "model/kinematics.hpp"
#include "model/knot_state.hpp"
#include "model/rigid_body.hpp"
#include "tests/unit/control/control_tick_fixture.hpp"

namespace hopscotch::control {
namespace {

using core::Joint;
using core::joint_index;
using core::Leg;

constexpr double kLate = 0.29;   // shortly before the touchdown of the plan [s]
constexpr double kEarly = 0.24;  // before the middle of its flight [s]

class DisturbedFlight : public ::testing::Test {
 protected:
  DisturbedFlight() {
    core::JointVector q0;
    q0 << 0, 0, 0.9, -1.8, 0.9, 0, 0, 0.9, -1.8, 0.9;
    plan_ = testing::jump_shaped_plan(q0);
    gains_ = testing::test_config().gains;
    gains_.stretch_per_turn = 0.2;
    gains_.stretch_dead = 0.1;
    gains_.stretch_max = 0.05;
  }

  /// The plan's own motion at a time, with the trunk turned beside it.
  [[nodiscard]] core::RobotState flying(double time, double turned) const {
    core::JumpKnot knot = sample_plan(plan_, time);
    core::RobotState state = model::state_of(knot);
    // The CoM as planned: what a turned trunk does to its speed is not this test's matter.
    state.v_WB += knot.v_WG - model::composite_body(robot_, state).v_WG;
    knot.rpy.y() += turned;
    state.R_WB = model::rotation_from_rpy(knot.rpy);
    return state;
  }
  [[nodiscard]] core::JointVector aimed(double time, double turned) const {
    core::JointVector q = sample_plan(plan_, time).q;
    aim_legs(gains_, robot_, flying(time, turned), {plan_, time}, q);
    return q;
  }
  [[nodiscard]] core::RobotState with(core::RobotState state, const core::JointVector& q) const {
    state.q = q;
    return state;
  }
  /// Ankle below the hip, in B [m].
  [[nodiscard]] Eigen::Vector3d reach(const core::JointVector& q) const {
    const core::LegVector leg = q.head<core::kJointsPerLeg>();
    core::LegVector flat = leg;
    const double a = robot_.thigh_length();
    const double b = robot_.shank_length();
    const double thigh = flat[core::joint_index(Leg::left, Joint::hip_pitch)];
    const double shank = thigh + flat[core::joint_index(Leg::left, Joint::knee)];
    return {-a * std::sin(thigh) - b * std::sin(shank), 0.0,
            -a * std::cos(thigh) - b * std::cos(shank)};
  }
  static double sum_of(const core::JointVector& q) {
    return q[joint_index(Leg::left, Joint::hip_pitch)] + q[joint_index(Leg::left, Joint::knee)] +
           q[joint_index(Leg::left, Joint::ankle)];
  }

  model::RobotParameters robot_ =
      model::RobotParameters::load(HOPSCOTCH_SOURCE_DIR "/config/robots/hector.yaml");
  core::JumpPlan plan_;
  JointGains gains_;
};

TEST_F(DisturbedFlight, StretchedLegsReachStraightDown) {
  constexpr double kBy = 0.04;
  constexpr double kPitch = -0.4;
  core::JointVector q = sample_plan(plan_, kLate).q;
  const Eigen::Vector3d before = reach(q);
  const double level = sum_of(q);
  core::JointVector dq = core::JointVector::Zero();
  stretch_legs(robot_, kPitch, {kBy, 0.0}, q, dq);
  const Eigen::AngleAxisd in_W(kPitch, Eigen::Vector3d::UnitY());
  EXPECT_LT((in_W * (reach(q) - before) - Eigen::Vector3d(0.0, 0.0, -kBy)).norm(), 1e-9);
  EXPECT_NEAR(sum_of(q), level, 1e-12);
  EXPECT_EQ(dq, core::JointVector::Zero());
}

TEST_F(DisturbedFlight, StretchingRatesAreThoseOfTheAngles) {
  constexpr double kRate = 0.3;
  constexpr double kStep = 1e-6;
  core::JointVector q = sample_plan(plan_, kLate).q;
  core::JointVector later = q;
  core::JointVector dq = core::JointVector::Zero();
  core::JointVector unused = core::JointVector::Zero();
  stretch_legs(robot_, -0.3, {0.02, kRate}, q, dq);
  stretch_legs(robot_, -0.3, {0.02 + kRate * kStep, kRate}, later, unused);
  EXPECT_LT((dq - (later - q) / kStep).norm(), 1e-4);
}

TEST_F(DisturbedFlight, WhatGoesAsPlannedIsLeftAsPlanned) {
  EXPECT_LT((aimed(kLate, 0.0) - sample_plan(plan_, kLate).q).norm(), 1e-9);
  core::JumpPlan landing = plan_;
  EXPECT_FALSE(shape_landing(robot_, flying(plan_.touchdown_time, 0.0), landing));
  for (std::size_t i = 0; i < plan_.knot_count; ++i) {
    EXPECT_EQ(landing.knots[i].q, plan_.knots[i].q);
    EXPECT_EQ(landing.knots[i].p_WG, plan_.knots[i].p_WG);
  }
}

TEST_F(DisturbedFlight, ATrunkThatTurnsTooFarMeetsTheGroundEarlier) {
  // How much lower the ankle is than with legs that are not stretched.
  const auto lowered = [&](double time, double turned) {
    JointGains unstretched = gains_;
    unstretched.stretch_max = 0.0;
    core::JointVector q = sample_plan(plan_, time).q;
    aim_legs(unstretched, robot_, flying(time, turned), {plan_, time}, q);
    const Eigen::AngleAxisd in_W(sample_plan(plan_, time).rpy.y() + turned,
                                 Eigen::Vector3d::UnitY());
    return (in_W * (reach(q) - reach(aimed(time, turned)))).eval();
  };
  const auto expect_lowered = [&](double time, double turned, double by) {
    EXPECT_LT((lowered(time, turned) - Eigen::Vector3d(0.0, 0.0, by)).norm(), 1e-6) << turned;
  };
  expect_lowered(kLate, 0.2, 0.02);
  expect_lowered(kLate, -0.2, 0.02);
  expect_lowered(kLate, 0.6, gains_.stretch_max);
  expect_lowered(kEarly, 0.3, 0.0);
}

TEST_F(DisturbedFlight, LegsDoNotReachIntoARiserOnTheWay) {
  constexpr double kTurned = 0.6;
  const auto tips = [&] {
    return model::sole_tips(
        robot_, model::sole_poses(robot_, with(flying(kLate, kTurned), aimed(kLate, kTurned)))[0]);
  };
  const model::SoleTips free = tips();  // the target says nothing about the ground
  // A step whose edge the sole is over, 5 cm below a sole that is not stretched.
  const double top = free.heel.z() + gains_.stretch_max - 0.05;
  const double edge = 0.5 * (free.heel.x() + free.toe.x());
  core::LandingTarget& target = plan_.target;
  target.p_WS.setZero();
  target.heading = 0.0;
  target.height = top;
  for (int i = 0; i < core::TerrainProfile::kSamples; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double height = core::TerrainProfile::x(i) < edge ? top - 0.2 : top;
    target.profile.mean[at] = target.profile.upper[at] = height;
  }
  const model::SoleTips over_edge = tips();
  EXPECT_GT(std::min(over_edge.heel.z(), over_edge.toe.z()), top + 0.01);
  EXPECT_GT(over_edge.heel.z(), free.heel.z() + 0.01);
  // Once it is over the step, its top is what the legs reach for.
  target.profile.mean.fill(top);
  target.profile.upper.fill(top);
  EXPECT_NEAR(tips().heel.z(), free.heel.z(), 1e-9);
}

TEST_F(DisturbedFlight, HipsStayOffTheirStopsAndSolesLevel) {
  constexpr double kTurned = -1.0;
  const core::JointVector q = aimed(kLate, kTurned);
  const double hip = q[joint_index(Leg::left, Joint::hip_pitch)];
  EXPECT_LT(hip, model::joint_range(robot_, Leg::left, Joint::hip_pitch).upper);
  EXPECT_NEAR(sum_of(q), sum_of(sample_plan(plan_, kLate).q) - kTurned, 1e-9);
}

TEST_F(DisturbedFlight, ALandingBeginsAsTheRobotCameDown) {
  constexpr double kTurned = 0.3;
  constexpr double kDead = 0.1;
  core::RobotState state = flying(plan_.touchdown_time, kTurned);
  core::JointVector unused = core::JointVector::Zero();
  stretch_legs(robot_, 0.0, {0.05, 0.0}, state.q, unused);
  core::JumpPlan landing = plan_;
  EXPECT_TRUE(shape_landing(robot_, state, landing));
  const core::JumpKnot begin = sample_plan(landing, landing.touchdown_time);
  const core::JumpKnot planned = sample_plan(plan_, plan_.touchdown_time);
  EXPECT_NEAR(begin.rpy.y(), planned.rpy.y() + kTurned - kDead, 1e-9);
  const double rise = begin.p_WG.z() - planned.p_WG.z();
  EXPECT_GT(rise, 0.01);
  EXPECT_LT(rise, 0.05);
  EXPECT_GT(reach(begin.q).norm(), reach(planned.q).norm() + 0.01);
  for (std::size_t i = 0; i + 1 < plan_.knot_count; ++i) {
    const core::JumpKnot& knot = landing.knots[i];
    if (knot.phase != core::JumpPhase::landing) {
      EXPECT_EQ(knot.q, plan_.knots[i].q);
      continue;
    }
    EXPECT_LE(landing.knots[i + 1].p_WG.z(), knot.p_WG.z());
  }
}

TEST_F(DisturbedFlight, ALandingGoesOnFromWhatTheImpactLeft) {
  const double time = plan_.touchdown_time + 0.03;
  core::RobotState state = flying(time, 0.0);
  core::JointVector unused = core::JointVector::Zero();
  stretch_legs(robot_, 0.0, {0.03, 0.0}, state.q, unused);
  const model::CompositeBody body = model::composite_body(robot_, state);
  state.v_WB.z() += 0.4;
  const auto height_over_soles = [&](const core::RobotState& at) {
    return model::composite_body(robot_, at).p_WG.z() -
           model::sole_poses(robot_, at)[0].translation().z();
  };
  core::JumpPlan landing = plan_;
  shape_after_impact(robot_, state, time, landing);
  const core::JumpKnot before = sample_plan(plan_, time);
  const core::JumpKnot after = sample_plan(landing, time);
  EXPECT_NEAR(after.p_WG.z() - before.p_WG.z(),
              height_over_soles(state) -
                  (before.p_WG.z() -
                   model::sole_poses(robot_, model::state_of(before))[0].translation().z()),
              1e-6);
  EXPECT_NEAR(after.v_WG.z(), body.v_WG.z() + 0.4, 1e-6);
  // The joints move at the rates of their places.
  constexpr double kStep = 1e-4;
  const core::JointVector rate =
      (sample_plan(landing, time + kStep).q - sample_plan(landing, time).q) / kStep;
  EXPECT_LT((rate - after.dq).norm(), 0.05);
}

}  // namespace
}  // namespace hopscotch::control
