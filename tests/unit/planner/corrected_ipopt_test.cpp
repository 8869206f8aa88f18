#include "planner/corrected_ipopt.hpp"

#include <gtest/gtest.h>

#include "planner/certificate.hpp"
#include "planner/certified_plan.hpp"
#include "planner/warm_start.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner::testing_support {
namespace {

class CorrectedIpopt : public testing::TestWithParam<std::pair<double, double>> {
 protected:
  PlanarModel model_ = shipped_model();
  DecisionLayout layout_{model_.config.steps};
  PlanarTask task_ = task(model_, GetParam().first, GetParam().second);
  Eigen::VectorXd guess_ = kinematic_guess(model_, task_, layout_);
};

TEST_P(CorrectedIpopt, IsExactBetweenTheKnots) {
  const SolvedMotion solved = solve_corrected_with_ipopt(model_, task_, layout_, guess_);
  ASSERT_TRUE(is_acceptable(solved.outcome));
  EXPECT_LE(certify(model_, task_, solved.motion).certificate.dense_max_violation,
            kDenseViolationMax);
}

/// Two solvers, two programs, one jump.
TEST_P(CorrectedIpopt, FindsTheJumpThatTheChainFinds) {
  const SolvedMotion reference = solve_corrected_with_ipopt(model_, task_, layout_, guess_);
  CorrectedSolver chain(layout_);
  const SolvedMotion ours = chain.solve(model_, task_, guess_);
  ASSERT_TRUE(is_acceptable(ours.outcome));
  EXPECT_NEAR(ours.outcome.cost, reference.outcome.cost, 2e-3 * reference.outcome.cost);
  ASSERT_EQ(ours.motion.knots.size(), reference.motion.knots.size());
  for (std::size_t i = 0; i < ours.motion.knots.size(); ++i) {
    for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
      EXPECT_NEAR(ours.motion.knots[i].links.pitch[j], reference.motion.knots[i].links.pitch[j],
                  0.01)
          << "knot " << i << " link " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Jumps, CorrectedIpopt,
                         testing::Values(std::pair{0.40, 0.0}, std::pair{0.40, 0.10},
                                         std::pair{0.30, 0.15}, std::pair{0.45, -0.10}));

/// No motion: what comes back says so and is no longer corrected.
TEST(CorrectedIpoptRefuses, WhatNoMotionReaches) {
  const PlanarModel model = shipped_model();
  const DecisionLayout layout(model.config.steps);
  const PlanarTask far = task(model, 0.60, 0.40);
  const SolvedMotion solved =
      solve_corrected_with_ipopt(model, far, layout, kinematic_guess(model, far, layout));
  EXPECT_FALSE(is_acceptable(solved.outcome));
}

}  // namespace
}  // namespace hopscotch::planner::testing_support
