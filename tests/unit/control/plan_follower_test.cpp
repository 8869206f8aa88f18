#include "control/plan_follower.hpp"

#include <gtest/gtest.h>

#include "tests/unit/control/fake_plan.hpp"

namespace hopscotch::control {
namespace {

const core::JumpPlan kPlan = testing::jump_shaped_plan(core::JointVector::Zero());

TEST(PlanFollower, KnotsAreReturnedAsTheyStand) {
  for (std::size_t i = 0; i < kPlan.knot_count; ++i) {
    const core::JumpKnot knot = sample_plan(kPlan, kPlan.knots[i].time);
    EXPECT_DOUBLE_EQ(knot.p_WG.x(), kPlan.knots[i].p_WG.x());
    EXPECT_DOUBLE_EQ(knot.q[3], kPlan.knots[i].q[3]);
    EXPECT_EQ(knot.phase, kPlan.knots[i].phase);
  }
}

TEST(PlanFollower, ConstantAccelerationIsInterpolatedExactly) {
  for (double t = 0.0; t < kPlan.duration; t += 0.0037) {
    const core::JumpKnot knot = sample_plan(kPlan, t);
    EXPECT_NEAR(knot.p_WG.x(), t * t, 1e-12);
    EXPECT_NEAR(knot.v_WG.x(), 2.0 * t, 1e-12);
    EXPECT_NEAR(knot.q[0], 0.01 * t * t, 1e-12);
  }
}

TEST(PlanFollower, TorqueIsLinearBetweenMidPointsOfAPhase) {
  for (double t = 0.011; t < 0.19; t += 0.003) {
    EXPECT_NEAR(sample_plan(kPlan, t).tau[2], 10.0 * t, 1e-12) << t;
  }
}

TEST(PlanFollower, TorqueDoesNotLeakFromOnePhaseIntoTheNext) {
  EXPECT_NEAR(sample_plan(kPlan, 0.1999).tau[2], 10.0 * 0.19, 1e-12);  // last takeoff mid-point
  EXPECT_DOUBLE_EQ(sample_plan(kPlan, 0.2001).tau[2], 0.0);
  EXPECT_DOUBLE_EQ(sample_plan(kPlan, 0.2999).tau[2], 0.0);
}

TEST(PlanFollower, RatesBeforeTouchdownAreThoseOfTheFlight) {
  core::JumpPlan plan = kPlan;
  for (std::size_t i = 0; i < plan.knot_count; ++i) {  // the ground stops the joints at once
    if (plan.knots[i].phase == core::JumpPhase::landing) plan.knots[i].dq.setZero();
  }
  EXPECT_NEAR(sample_plan(plan, 0.2999).dq[0], 0.02 * 0.2999, 1e-6);
  EXPECT_DOUBLE_EQ(sample_plan(plan, 0.3).dq[0], 0.0);
}

TEST(PlanFollower, TimeIsClampedToThePlan) {
  EXPECT_DOUBLE_EQ(sample_plan(kPlan, -1.0).p_WG.x(), 0.0);
  EXPECT_NEAR(sample_plan(kPlan, 9.0).p_WG.x(), 0.42 * 0.42, 1e-12);
}

PlanPlacement placement() {
  PlanPlacement placement;
  placement.takeoff.shift = {1.0, 0.0, 0.0};
  placement.landing.shift = {2.0, 0.0, 0.0};
  placement.takeoff.soles = {Eigen::Vector3d(0, 0.1, 0), Eigen::Vector3d(0, -0.1, 0)};
  placement.landing.soles = {Eigen::Vector3d(0.4, 0.1, 0), Eigen::Vector3d(0.4, -0.1, 0)};
  return placement;
}

core::ControlReference window(double time, std::size_t horizon) {
  core::ControlReference reference;
  reference.horizon = horizon;
  fill_reference(kPlan, time, placement(), reference);
  return reference;
}

TEST(PlanFollower, AFixedFrequencyIgnoresThePlansSteps) {
  core::ControlReference reference;
  reference.horizon = 8;
  fill_reference_fixed(kPlan, 0.17, placement(), 0.03, reference);
  for (std::size_t k = 0; k <= reference.horizon; ++k) {
    EXPECT_DOUBLE_EQ(reference.knots[k].dt, 0.03);
  }
  EXPECT_TRUE(reference.knots[0].contact[0]);
  EXPECT_FALSE(reference.knots[1].contact[0]);
  EXPECT_NEAR(reference.knots[1].p_WG.x(), 0.2 * 0.2 + 1.0, 1e-12);
}

TEST(PlanFollower, WindowUsesThePlansOwnStepLengths) {
  const core::ControlReference reference = window(0.0, 20);
  double t = 0.0;
  for (std::size_t k = 0; k < reference.horizon; ++k) {
    const double expected = t < 0.1999 ? 0.02 : (t < 0.2999 ? 0.025 : 0.03);
    EXPECT_NEAR(reference.knots[k].dt, expected, 1e-9) << k;
    t += reference.knots[k].dt;
  }
}

TEST(PlanFollower, StepsEndWhereAPhaseEnds) {
  const core::ControlReference reference = window(0.193, 4);
  EXPECT_NEAR(reference.knots[0].dt, 0.007, 1e-12);
  EXPECT_TRUE(reference.knots[0].contact[0]);
  EXPECT_FALSE(reference.knots[1].contact[0]);
}

TEST(PlanFollower, LandingIsShiftedByItsOwnAnchorAndSoles) {
  const core::ControlReference reference = window(0.25, 6);
  EXPECT_NEAR(reference.knots[0].p_WG.x(), 0.25 * 0.25 + 1.0, 1e-12);
  EXPECT_NEAR(reference.knots[2].p_WG.x(), 0.3 * 0.3 + 2.0, 1e-12);
  EXPECT_DOUBLE_EQ(reference.knots[2].p_WF[0].x(), 0.4);
}

TEST(PlanFollower, AJumpTurnsBesideItsPlanFromTheEndOfTheTakeoffOn) {
  core::ControlReference straight = window(0.0, 14);
  core::ControlReference turned = straight;
  PlanPlacement beside = placement();
  beside.takeoff.turn = 0.02;
  beside.landing.turn = 0.017;
  fill_reference(kPlan, 0.0, beside, turned);
  const auto extra = [&](std::size_t k) {
    return turned.knots[k].rpy.z() - straight.knots[k].rpy.z();
  };
  EXPECT_DOUBLE_EQ(extra(2), 0.0);            // at 0.04 s
  EXPECT_GT(turned.knots[10].w_WB.z(), 0.1);  // lift-off
  for (std::size_t k = 10; k < 13; ++k) {
    EXPECT_NEAR(extra(k + 1) - extra(k), turned.knots[k].dt * turned.knots[k].w_WB.z(), 1e-9);
  }
  EXPECT_NEAR(extra(13) + turned.knots[13].dt * turned.knots[13].w_WB.z(), 0.02, 1e-9);
  EXPECT_DOUBLE_EQ(extra(14), 0.017);  // touchdown: where the soles point
  EXPECT_DOUBLE_EQ(turned.knots[14].w_WB.z(), straight.knots[14].w_WB.z());
  beside.takeoff.turn = -1.0;
  fill_reference(kPlan, 0.0, beside, turned);
  EXPECT_NEAR(extra(13) + turned.knots[13].dt * turned.knots[13].w_WB.z(), -0.03, 1e-9);
}

TEST(PlanFollower, PastItsEndThePlanIsHeld) {
  const core::ControlReference reference = window(0.5, 5);
  for (std::size_t k = 0; k <= reference.horizon; ++k) {
    EXPECT_NEAR(reference.knots[k].dt, 0.03, 1e-12);
    EXPECT_NEAR(reference.knots[k].p_WG.x(), 0.42 * 0.42 + 2.0, 1e-12);
    EXPECT_TRUE(reference.knots[k].contact[1]);
  }
}

}  // namespace
}  // namespace hopscotch::control
