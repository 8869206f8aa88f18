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
  const auto update = [&] {
    return update_correction(model, task, problem.layout(), {motion, solver.slot_values()},
                             correction)
        .dynamics;
  };
  double before = update();
  EXPECT_GT(before, 5e-3);
  for (int pass = 0; pass < 2; ++pass) {
    problem.correct(correction);
    const ChainOutcome polished = solver.polish(problem, options);
    ASSERT_EQ(polished.status, SolveStatus::solved);
    EXPECT_LE(polished.iterations, 10);
    motion = motion_from_decision(model, task, layout, solver.x());
    set_correction(correction, motion);
    const double after = update();
    EXPECT_LT(after, 0.4 * before);
    before = after;
  }
}

/// A solved jump with what it needs to be corrected.
struct Solved {
  PlanarModel model = shipped_model();
  DecisionLayout layout{model.config.steps};
  PlanarTask task;
  ChainProblem problem;
  ChainSolver solver{layout};
  PlanarMotion motion;

  Solved(double distance, double height)
      : task(testing_support::task(model, distance, height)), problem(model, task, layout) {
    const ChainOutcome outcome =
        solver.solve(problem, kinematic_guess(model, task, layout),
                     {model.config.iterations_max, model.config.tolerance});
    EXPECT_EQ(outcome.status, SolveStatus::solved);
    motion = motion_from_decision(model, task, layout, solver.x());
  }

  [[nodiscard]] double missed_limits(ChainCorrection& correction) const {
    return update_correction(model, task, problem.layout(), {motion, solver.slot_values()},
                             correction)
        .limits;
  }
};

TEST(ChainCorrection, BoundsARowThatBreaksItsLimitBetweenMidPoints) {
  Solved jump(0.40, 0.0);
  ChainCorrection fine(jump.problem.layout());
  EXPECT_LE(jump.missed_limits(fine), 0.0);
  jump.model.config.friction *= 0.6;  // less than the plan's own share of it
  ChainCorrection tight(jump.problem.layout());
  EXPECT_GT(jump.missed_limits(tight), 0.01);
  jump.problem.correct(fine);
  const Eigen::VectorXd before = jump.problem.lower();
  jump.problem.correct(tight);
  EXPECT_GT((jump.problem.lower() - before).maxCoeff(), 0.01);
  EXPECT_GE((jump.problem.lower() - before).minCoeff(), 0.0);
}

TEST(ChainCorrection, ShanksClearTheEdgeOfABlockBetweenKnotsToo) {
  JumpPlanner planner(shipped_config(), hector());
  const auto plan = planner.plan(request(0.35, -0.28));
  ASSERT_TRUE(plan) << plan.error().text();
  for (std::size_t i = 0; i < plan->certificate.count; ++i) {
    EXPECT_GE(plan->certificate.entries[i].margin, -1e-3) << plan->certificate.entries[i].name;
  }
}

TEST(ChainCorrection, ClearedCorrectsNothing) {
  Solved jump(0.40, 0.0);
  const Eigen::VectorXd lower = jump.problem.lower();
  const Eigen::VectorXd upper = jump.problem.upper();
  ChainCorrection correction(jump.problem.layout());
  (void)jump.missed_limits(correction);
  correction.clear();
  jump.problem.correct(correction);
  EXPECT_EQ(jump.problem.lower(), lower);
  EXPECT_EQ(jump.problem.upper(), upper);
  for (const StepCorrection& step : correction.steps) {
    EXPECT_EQ(step.turn, model::LinkArray<double>{});
    EXPECT_EQ(step.acceleration, model::LinkArray<double>{});
  }
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
  EXPECT_GE(plan->certificate.binding().margin, -1e-3) << plan->certificate.binding().name;
}

INSTANTIATE_TEST_SUITE_P(Some, ExactJumps,
                         testing::Values(Jump{0.25, 0.0}, Jump{0.40, 0.0}, Jump{0.50, 0.0},
                                         Jump{0.35, 0.15}, Jump{0.30, 0.20}, Jump{0.40, -0.10},
                                         Jump{0.45, -0.20}, Jump{0.55, 0.10}, Jump{0.384, -0.30}));

}  // namespace
}  // namespace hopscotch::planner
