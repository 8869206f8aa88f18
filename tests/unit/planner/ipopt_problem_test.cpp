#include "planner/ipopt_problem.hpp"

#include <gtest/gtest.h>

#include "planner/block_forms.hpp"

namespace hopscotch::planner {
namespace {

/// Rosenbrock's valley inside a disc: minimise 100 (y - x^2)^2 + (1 - x)^2, x^2 + y^2 <= r^2.
struct ValleyLaw {
  static constexpr int kRows = 1;
  double radius = 2.0;
  template <typename T>
  T operator()(const std::array<T, 2>& x, std::array<T, kRows>& rows) const {
    rows[0] = x[0] * x[0] + x[1] * x[1];
    const T bend = x[1] - x[0] * x[0];
    const T along = 1.0 - x[0];
    return 100.0 * bend * bend + along * along;
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    lower[0] = 0.0;
    upper[0] = radius * radius;
  }
};

SolveOutcome solve(double radius, int iterations) {
  std::vector<std::unique_ptr<ConstraintBlock>> blocks;
  blocks.push_back(
      std::make_unique<KnotBlock<ValleyLaw, 2>>(ValleyLaw{radius}, std::array<int, 2>{0, 1}));
  const NonlinearProgram nlp(2, std::move(blocks));
  const DecisionBounds bounds{Eigen::Vector2d(-5.0, -5.0), Eigen::Vector2d(5.0, 5.0)};
  return solve_with_ipopt(nlp, bounds, Eigen::Vector2d(1.0, 2.0), {Eigen::Vector2d(-1.0, 1.5)},
                          {iterations, 1e-8});
}

TEST(IpoptProblem, FindsAFreeMinimum) {
  const SolveOutcome outcome = solve(2.0, 200);
  EXPECT_EQ(outcome.status, SolveStatus::solved);
  EXPECT_TRUE(outcome.x.isApprox(Eigen::Vector2d(1.0, 1.0), 1e-5));
  EXPECT_LT(outcome.violation, 1e-8);
}

TEST(IpoptProblem, FindsAMinimumOnTheBoundary) {
  const SolveOutcome outcome = solve(1.0, 200);
  EXPECT_EQ(outcome.status, SolveStatus::solved);
  EXPECT_NEAR(outcome.x.norm(), 1.0, 1e-6);
  // At the boundary the gradient of the cost points along x.
  const double x = outcome.x(0);
  const double y = outcome.x(1);
  const Eigen::Vector2d gradient(-400.0 * x * (y - x * x) - 2.0 * (1.0 - x), 200.0 * (y - x * x));
  EXPECT_NEAR(gradient(0) * y - gradient(1) * x, 0.0, 1e-5);
}

TEST(IpoptProblem, SaysWhenItRanOutOfIterations) {
  const SolveOutcome outcome = solve(2.0, 2);
  EXPECT_EQ(outcome.status, SolveStatus::iteration_limit);
  EXPECT_EQ(outcome.iterations, 2);
}

/// x^2 <= -1 has no solution.
struct ImpossibleLaw {
  static constexpr int kRows = 1;
  template <typename T>
  T operator()(const std::array<T, 1>& x, std::array<T, kRows>& rows) const {
    rows[0] = x[0] * x[0];
    return x[0];
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    lower[0] = -2.0;
    upper[0] = -1.0;
  }
};

TEST(IpoptProblem, GivesUpOnTheImpossible) {
  std::vector<std::unique_ptr<ConstraintBlock>> blocks;
  blocks.push_back(
      std::make_unique<KnotBlock<ImpossibleLaw, 1>>(ImpossibleLaw{}, std::array<int, 1>{0}));
  const NonlinearProgram nlp(1, std::move(blocks));
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  const SolveOutcome outcome =
      solve_with_ipopt(nlp, {-5.0 * one, 5.0 * one}, one, {one}, {200, 1e-6});
  EXPECT_EQ(outcome.status, SolveStatus::infeasible);
  EXPECT_GT(outcome.violation, 0.9);
}

TEST(IpoptProblem, SameInputGivesTheSameBits) {
  const SolveOutcome a = solve(1.0, 200);
  const SolveOutcome b = solve(1.0, 200);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.iterations, b.iterations);
}

}  // namespace
}  // namespace hopscotch::planner
