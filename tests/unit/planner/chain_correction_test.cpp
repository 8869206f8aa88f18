#include "planner/chain_correction.hpp"

#include <gtest/gtest.h>

#include "planner/certificate.hpp"
#include "planner/chain_solver.hpp"
#include "planner/warm_start.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::hector;
using testing_support::request;
using testing_support::shipped_config;
using testing_support::shipped_model;

TEST(ChainCorrection, EachPassLeavesAFractionOfTheDefect) {
  const PlanarModel model = shipped_model();
  const DecisionLayout layout(model.config.steps);
  const PlanarTask task = testing_support::task(model, 0.40, 0.0);
  ChainProblem problem(model, task, layout);
  ChainSolver solver(layout);
  const SolveOptions options{model.config.iterations_max, model.config.tolerance};
  ASSERT_EQ(solver.solve(problem, kinematic_guess(model, task, layout), options).status,
            SolveStatus::solved);
  ChainCorrection correction(problem.layout());
  PlanarMotion motion = motion_from_decision(model, task, layout, solver.x());
  double before = add_correction(model, motion, problem.layout(), correction).dynamics;
  EXPECT_GT(before, 5e-3);
  for (int pass = 0; pass < 2; ++pass) {
    problem.correct(correction);
    const ChainOutcome polished = solver.polish(problem, options);
    ASSERT_EQ(polished.status, SolveStatus::solved);
    EXPECT_LE(polished.iterations, 10);
    motion = motion_from_decision(model, task, layout, solver.x());
    set_correction(correction, motion);
    const double after = add_correction(model, motion, problem.layout(), correction).dynamics;
    EXPECT_LT(after, 0.4 * before);
    before = after;
  }
}

TEST(ChainCorrection, TightensARowThatBreaksItsLimitBetweenMidPoints) {
  PlanarModel model = shipped_model();
  const DecisionLayout layout(model.config.steps);
  const PlanarTask task = testing_support::task(model, 0.40, 0.0);
  const ChainProblem problem(model, task, layout);
  ChainSolver solver(layout);
  ASSERT_EQ(solver
                .solve(problem, kinematic_guess(model, task, layout),
                       {model.config.iterations_max, model.config.tolerance})
                .status,
            SolveStatus::solved);
  const PlanarMotion motion = motion_from_decision(model, task, layout, solver.x());
  ChainCorrection fine(problem.layout());
  EXPECT_EQ(add_correction(model, motion, problem.layout(), fine).limits, 0.0);
  model.config.friction *= 0.6;  // less than the plan's own share of it
  ChainCorrection tight(problem.layout());
  EXPECT_GT(add_correction(model, motion, problem.layout(), tight).limits, 0.01);
  EXPECT_GT(tight.tightening.maxCoeff(), 0.01);
}

struct Jump {
  double distance, height;
};
class ExactJumps : public testing::TestWithParam<Jump> {};

TEST_P(ExactJumps, HoldBetweenTheKnots) {
  JumpPlanner planner(shipped_config(), hector());
  const auto plan = planner.plan(request(GetParam().distance, GetParam().height));
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_LT(plan->certificate.dense_max_violation, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Some, ExactJumps,
                         testing::Values(Jump{0.25, 0.0}, Jump{0.40, 0.0}, Jump{0.50, 0.0},
                                         Jump{0.35, 0.15}, Jump{0.30, 0.20}, Jump{0.40, -0.10},
                                         Jump{0.45, -0.20}));

}  // namespace
}  // namespace hopscotch::planner
