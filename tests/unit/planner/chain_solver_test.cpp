#include "planner/chain_solver.hpp"

#include <gtest/gtest.h>

#include "core/allocation_count.hpp"
#include "planner/ipopt_problem.hpp"
#include "tests/unit/planner/chain_fixture.hpp"

namespace hopscotch::planner::testing_support {
namespace {

constexpr SolveOptions kTight{150, 1e-6};
constexpr SolveOptions kOnLine{80, 1e-3};

struct SolvedChain {
  PlanarModel model = shipped_model();
  PlanarTask task;
  DecisionLayout layout{model.config.steps};
  ChainProblem problem;
  ChainSolver solver{layout};
  ChainOutcome outcome;

  SolvedChain(double distance, double height, const SolveOptions& options)
      : task(testing_support::task(model, distance, height)), problem(model, task, layout) {
    outcome = solver.solve(problem, kinematic_guess(model, task, layout), options);
  }
};

class ChainSolverTest : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(ChainSolverTest, FindsTheOptimumThatIpoptFinds) {
  const SolvedChain chain(GetParam().first, GetParam().second, kTight);
  ASSERT_EQ(chain.outcome.status, SolveStatus::solved);
  const SolveOutcome reference = solve_with_ipopt(
      jump_program(chain.model, chain.task, chain.layout),
      decision_bounds(chain.model, chain.task, chain.layout), decision_sizes(chain.layout),
      {kinematic_guess(chain.model, chain.task, chain.layout)}, {200, 1e-7});
  ASSERT_EQ(reference.status, SolveStatus::solved);
  EXPECT_NEAR(chain.outcome.cost, reference.cost, 1e-5 * reference.cost);
}

TEST_P(ChainSolverTest, OnLineToleranceCostsLittle) {
  const SolvedChain tight(GetParam().first, GetParam().second, kTight);
  const SolvedChain quick(GetParam().first, GetParam().second, kOnLine);
  ASSERT_EQ(quick.outcome.status, SolveStatus::solved);
  EXPECT_LT(quick.outcome.iterations, 45);
  EXPECT_NEAR(quick.outcome.cost, tight.outcome.cost, 1e-4 * tight.outcome.cost);
}

/// Stationarity, feasibility, signs and complementarity by the derivatives of the blocks.
TEST_P(ChainSolverTest, SatisfiesTheOptimalityConditionsOfTheBlocks) {
  const SolvedChain chain(GetParam().first, GetParam().second, kTight);
  const NonlinearProgram program = jump_program(chain.model, chain.task, chain.layout);
  const RowPlaces places(chain.problem);
  const Eigen::VectorXd x = chain.solver.x();
  Eigen::VectorXd rows;
  program.values(x.data(), rows);
  EXPECT_LT((program.row_lower() - rows).maxCoeff(), 1e-5);
  EXPECT_LT((rows - program.row_upper()).maxCoeff(), 1e-5);
  const Eigen::VectorXd multipliers =
      places.gather(chain.solver.slot_multipliers(), chain.solver.equality_multipliers());
  for (int r = 0; r < program.rows(); ++r) {
    if (places.list()[static_cast<std::size_t>(r)].is_equality) continue;
    const double gap =
        multipliers(r) > 0.0 ? program.row_upper()(r) - rows(r) : rows(r) - program.row_lower()(r);
    EXPECT_LT(multipliers(r) == 0.0 ? 0.0 : std::abs(multipliers(r)) * gap, 1e-5) << "row " << r;
  }
  Eigen::VectorXd gradient;
  Eigen::VectorXd jacobian;
  program.slopes(x.data(), gradient, jacobian);
  gradient *= ChainProblem::kCostScale;
  for (std::size_t e = 0; e < program.jacobian_pattern().size(); ++e) {
    const SparseEntry& at = program.jacobian_pattern()[e];
    gradient(at.column) += multipliers(at.row) * jacobian(static_cast<Eigen::Index>(e));
  }
  for (int i = 0; i < program.variables(); ++i) {
    if (chain.problem.is_fixed(i)) continue;
    const double of_bound = chain.solver.slot_multipliers()(chain.problem.layout().variable(i));
    EXPECT_NEAR((gradient(i) + of_bound) * chain.problem.sizes()(i), 0.0, 1e-4) << i;
  }
}

TEST_P(ChainSolverTest, SameInputGivesTheSameBits) {
  const SolvedChain a(GetParam().first, GetParam().second, kOnLine);
  const SolvedChain b(GetParam().first, GetParam().second, kOnLine);
  EXPECT_EQ(a.outcome.iterations, b.outcome.iterations);
  EXPECT_EQ(Eigen::VectorXd(a.solver.x()), Eigen::VectorXd(b.solver.x()));
}

INSTANTIATE_TEST_SUITE_P(Jumps, ChainSolverTest,
                         testing::Values(std::pair{0.40, 0.0}, std::pair{0.40, 0.10},
                                         std::pair{0.30, 0.15}, std::pair{0.45, -0.10}));

TEST(ChainSolver, StartsAgainFromANeighbour) {
  SolvedChain chain(0.40, 0.0, kOnLine);
  ASSERT_EQ(chain.outcome.status, SolveStatus::solved);
  const PlanarTask next = task(chain.model, 0.42, 0.0);
  const ChainProblem problem(chain.model, next, chain.layout);
  const ChainOutcome warm = chain.solver.solve_near(problem, chain.solver.solution(), kOnLine);
  EXPECT_EQ(warm.status, SolveStatus::solved);
  EXPECT_LT(warm.iterations, chain.outcome.iterations);
  const SolvedChain cold(0.42, 0.0, kOnLine);
  EXPECT_NEAR(warm.cost, cold.outcome.cost, 2e-4 * cold.outcome.cost);
}

TEST(ChainSolver, SolvingAllocatesNothing) {
  SolvedChain chain(0.40, 0.0, kOnLine);
  const Eigen::VectorXd guess = kinematic_guess(chain.model, chain.task, chain.layout);
  const ChainSolution solution = chain.solver.solution();
  const std::size_t before = core::allocation_count();
  chain.outcome = chain.solver.solve(chain.problem, guess, kOnLine);
  chain.outcome = chain.solver.solve_near(chain.problem, solution, kOnLine);
  EXPECT_EQ(core::allocation_count(), before);
  EXPECT_EQ(chain.outcome.status, SolveStatus::solved);
}

TEST(ChainSolver, GivesUpOnTheImpossible) {
  const SolvedChain chain(0.60, 0.40, kOnLine);
  EXPECT_NE(chain.outcome.status, SolveStatus::solved);
  EXPECT_GT(chain.outcome.violation, 1e-2);
  EXPECT_LE(chain.outcome.iterations, kOnLine.iterations_max);
}

}  // namespace
}  // namespace hopscotch::planner::testing_support
