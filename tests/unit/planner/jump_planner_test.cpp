#include "planner/jump_planner.hpp"

#include <gtest/gtest.h>

#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::hector;
using testing_support::request;
using testing_support::shipped_config;

struct Jump {
  double distance;
  double height;
};

class RequiredJumps : public testing::TestWithParam<Jump> {};

TEST_P(RequiredJumps, AreSolvedAndCertified) {
  JumpPlanner planner(shipped_config(), hector());
  const core::Result<core::JumpPlan> plan =
      planner.plan(request(GetParam().distance, GetParam().height));
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_EQ(plan->status, core::PlanStatus::solved);
  EXPECT_GT(plan->certificate.binding().margin, 0.0);
  EXPECT_LT(plan->certificate.max_violation, 1e-3);
  EXPECT_LT(plan->peaks.torque_ratio, 1.0);
  EXPECT_LT(plan->peaks.power_ratio, 1.0);
  EXPECT_EQ(plan->id, 7U);
  EXPECT_LT(plan->liftoff_time, plan->touchdown_time);
  EXPECT_LT(plan->touchdown_time, plan->duration);
}

INSTANTIATE_TEST_SUITE_P(LevelUpAndDown, RequiredJumps,
                         testing::Values(Jump{0.25, 0.0}, Jump{0.40, 0.0}, Jump{0.45, 0.0},
                                         Jump{0.50, 0.0}, Jump{0.60, 0.0}, Jump{0.35, 0.05},
                                         Jump{0.35, -0.05}, Jump{0.40, 0.05}, Jump{0.40, 0.10},
                                         Jump{0.40, 0.15}, Jump{0.40, 0.20}, Jump{0.40, -0.25}));

TEST(JumpPlanner, LeapsAGapBetweenStones) {
  JumpPlanner planner(shipped_config(), hector());
  PlanRequest stones = request(0.45, 0.0);
  for (int i = 0; i < core::TerrainProfile::kSamples; ++i) {
    const double x = core::TerrainProfile::x(i);
    const bool gap = (x > 0.125 && x < 0.325) || x < -0.125;
    if (gap) stones.target.profile.upper[static_cast<std::size_t>(i)] = -0.5;
  }
  EXPECT_TRUE(planner.plan(stones));
}

TEST(JumpPlanner, SameRequestGivesTheSamePlan) {
  JumpPlanner planner(shipped_config(), hector());
  const core::Result<core::JumpPlan> a = planner.plan(request(0.40, 0.0));
  const core::Result<core::JumpPlan> b = planner.plan(request(0.40, 0.0));
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->knot_count, b->knot_count);
  EXPECT_EQ(a->iterations, b->iterations);
  for (std::size_t i = 0; i < a->knot_count; ++i) {
    EXPECT_EQ(a->knots[i].q, b->knots[i].q);
    EXPECT_EQ(a->knots[i].p_WG, b->knots[i].p_WG);
  }
}

TEST(JumpPlanner, PreviousJumpMakesAGoodGuessForItsNeighbour) {
  JumpPlanner planner(shipped_config(), hector());
  ASSERT_TRUE(planner.plan(request(0.40, 0.0)));
  PlanRequest next = request(0.42, 0.0);
  next.guess = StartGuess::previous;
  const core::Result<core::JumpPlan> warm = planner.plan(next);
  ASSERT_TRUE(warm);
  EXPECT_TRUE(warm->warm);
  next.guess = StartGuess::kinematic;
  const core::Result<core::JumpPlan> cold = planner.plan(next);
  ASSERT_TRUE(cold);
  EXPECT_FALSE(cold->warm);
}

TEST(JumpPlanner, StartsFromANoisyStand) {
  JumpPlanner planner(shipped_config(), hector());
  PlanRequest noisy = request(0.40, 0.0);
  noisy.start.q += 0.01 * core::JointVector::LinSpaced(-1.0, 1.0);
  noisy.start.dq += 0.05 * core::JointVector::LinSpaced(1.0, -1.0);
  noisy.start.w_WB.y() = 0.05;
  EXPECT_TRUE(planner.plan(noisy));
}

TEST(JumpPlanner, RefusesAnImpossibleJumpWithNumbers) {
  JumpPlanner planner(shipped_config(), hector());
  const core::Result<core::JumpPlan> plan = planner.plan(request(0.60, 0.40));
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().reason, core::Reason::plan_infeasible);
  EXPECT_NE(plan.error().sentence.find("0.600"), std::string::npos);
}

TEST(JumpPlanner, RefusesALandingWhoseShanksWouldLeanOnTheEdge) {
  JumpPlanner planner(shipped_config(), hector());
  const auto plan = planner.plan(request(0.29, -0.20));  // 17 cm beyond the edge
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().reason, core::Reason::plan_infeasible);
  EXPECT_EQ(planner.obstacle(), "shank clearance");
  EXPECT_TRUE(planner.plan(request(0.35, -0.20)));
}

TEST(JumpPlanner, RefusesWhatTheCertificateRefutes) {
  PlannerConfig config = shipped_config();
  config.friction = 0.02;
  config.reserves.friction = 1.0;
  // Hardly any friction: either no motion is found, or none that holds between the knots.
  JumpPlanner planner(config, hector());
  EXPECT_FALSE(planner.plan(request(0.40, 0.0)));
}

TEST(JumpPlanner, RefusesMoreStepsThanAPlanHolds) {
  PlannerConfig config = shipped_config();
  config.steps.takeoff = static_cast<int>(core::JumpPlan::kMaxKnots);
  EXPECT_THROW(JumpPlanner(config, hector()), std::invalid_argument);
}

}  // namespace
}  // namespace hopscotch::planner
