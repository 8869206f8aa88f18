#include "control/qp_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "core/allocation_count.hpp"
#include "tests/unit/control/dense_qp.hpp"
#include "tests/unit/control/random_wrench_qp.hpp"

namespace hopscotch::control {
namespace {

using testing::ContactPattern;
using testing::DenseFoot;
using testing::DenseQp;
using testing::DenseVector;
using testing::QpFamily;

constexpr QpTolerances kTolerances{.iteration_cap = 30, .gap = 1e-8, .stationarity = 1e-6};

struct NamedFamily {
  std::string name;
  QpFamily family;
};

std::ostream& operator<<(std::ostream& out, const NamedFamily& named) {
  return out << named.name;
}

/// Ordinary problems and the edges: little and much friction, weak and strong feet, short and long
/// steps, states far away, one foot, feet in turn, flight in the middle.
std::vector<NamedFamily> families() {
  return {
      {"stand", {}},
      {"one_foot", {.contact = ContactPattern::left_only}},
      {"alternating", {.contact = ContactPattern::alternating}},
      {"through_flight", {.contact = ContactPattern::through_flight}},
      {"far_state", {.spread = 0.6}},
      {"slippery", {.friction = 0.02}},
      {"sticky", {.friction = 1.2}},
      {"weak_foot", {.top = 20.0}},
      {"strong_foot", {.top = 2000.0}},
      {"short_steps", {.dt = 0.006}},
      {"long_steps", {.dt = 0.06}},
      {"cheap_wrench", {.weight_scale = 0.1}},
      {"dear_wrench", {.weight_scale = 1000.0}},
      {"yaw_moment_free", {.yaw_moment_free = true}},
      {"error_state", {.with_reference = true}},
      {"euler", {.rule = StepRule::euler}},
      {"one_step", {.horizon = 1}},
      {"longest_horizon", {.horizon = WrenchQp::kMaxHorizon}},
      {"everything",
       {.contact = ContactPattern::alternating,
        .spread = 0.6,
        .friction = 0.1,
        .top = 900.0,
        .dt = 0.05,
        .yaw_moment_free = true,
        .with_reference = true}},
  };
}

DenseVector inputs_of(const QpSolver& solver, const DenseQp& dense) {
  DenseVector z(5 * static_cast<Eigen::Index>(dense.feet.size()));
  for (const DenseFoot& foot : dense.feet) {
    z.segment(foot.first, 5) = solver.input(foot.step, foot.leg).cast<testing::Real>();
  }
  return z;
}

/// In the order of DenseQp's rows.
DenseVector multipliers_of(const QpSolver& solver, const DenseQp& dense) {
  DenseVector lambda(9 * static_cast<Eigen::Index>(dense.feet.size()));
  for (const DenseFoot& foot : dense.feet) {
    const ConeMultipliers m = solver.multipliers(foot.step, foot.leg);
    lambda.segment(foot.first / 5 * 9, 9) << m.upper.cast<testing::Real>().matrix(),
        m.lower.cast<testing::Real>().matrix(), static_cast<testing::Real>(m.top);
  }
  return lambda;
}

class QpSolverFamily : public ::testing::TestWithParam<NamedFamily> {};

TEST_P(QpSolverFamily, SolutionFulfilsOptimalityConditions) {
  std::mt19937 rng(4711);
  QpSolver solver(kTolerances);
  for (int i = 0; i < 10; ++i) {
    const WrenchQp qp = testing::random_wrench_qp(GetParam().family, rng);
    ASSERT_EQ(solver.solve_cold(qp), QpStatus::solved) << "problem " << i;
    const DenseQp dense = testing::condense(qp);
    const DenseVector z = inputs_of(solver, dense);
    const testing::KktResiduals kkt =
        testing::kkt_residuals(dense, z, multipliers_of(solver, dense));
    const double gradient_scale = static_cast<double>(dense.g.cwiseAbs().maxCoeff());
    const double objective = static_cast<double>(dense.objective(z));
    // Stationarity is stopped at 1e-6 of the gradient at the start, which is not that at zero.
    EXPECT_LE(kkt.stationarity, 1e-5 * (gradient_scale + 1.0)) << "problem " << i;
    // Slacks are carried along instead of recomputed; they drift by rounding only.
    EXPECT_LE(kkt.primal, 1e-9) << "problem " << i;
    EXPECT_EQ(kkt.dual, 0.0) << "problem " << i;
    EXPECT_LE(kkt.complementarity, 1.1 * kTolerances.gap * (1.0 + objective)) << "problem " << i;
  }
}

TEST_P(QpSolverFamily, AgreesWithDenseReference) {
  std::mt19937 rng(815);
  QpSolver solver(kTolerances);
  const int count = GetParam().family.horizon > 10 ? 1 : 2;  // the reference is slow
  for (int i = 0; i < count; ++i) {
    const WrenchQp qp = testing::random_wrench_qp(GetParam().family, rng);
    ASSERT_EQ(solver.solve_cold(qp), QpStatus::solved);
    const DenseQp dense = testing::condense(qp);
    const DenseVector z = testing::solve_dense(dense);
    const double best = static_cast<double>(dense.objective(z));
    // The gap bounds the objective error; the reference itself is good to 1e-12.
    EXPECT_NEAR(solver.objective(), best, 2e-8 * (1.0 + best));
    EXPECT_NEAR(static_cast<double>(dense.objective(inputs_of(solver, dense))), best,
                2e-8 * (1.0 + best));
  }
}

TEST_P(QpSolverFamily, StatesFollowTheDynamics) {
  std::mt19937 rng(31);
  QpSolver solver(kTolerances);
  const WrenchQp qp = testing::random_wrench_qp(GetParam().family, rng);
  ASSERT_EQ(solver.solve_cold(qp), QpStatus::solved);
  const DenseQp dense = testing::condense(qp);
  const DenseVector x = dense.free + dense.gain * inputs_of(solver, dense);
  for (int k = 1; k <= qp.horizon; ++k) {
    const BodyState expected = x.segment(12 * (k - 1), 12).cast<double>();
    // Rounding of about 1e-14 per iteration and step.
    EXPECT_LE((solver.state(k) - expected).cwiseAbs().maxCoeff(), 1e-10) << "knot " << k;
  }
}

TEST_P(QpSolverFamily, WarmStartFindsTheSameOptimum) {
  std::mt19937 rng(99);
  QpSolver cold(kTolerances);
  QpSolver warm(kTolerances);
  WarmStartMap same{};
  for (std::size_t k = 0; k < same.size(); ++k) same[k] = static_cast<int>(k);
  WrenchQp qp = testing::random_wrench_qp(GetParam().family, rng);
  ASSERT_EQ(warm.solve_cold(qp), QpStatus::solved);
  qp.x0 += BodyState::Constant(1e-3);
  ASSERT_EQ(warm.solve_warm(qp, same), QpStatus::solved);
  EXPECT_TRUE(warm.started_warm());
  ASSERT_EQ(cold.solve_cold(qp), QpStatus::solved);
  EXPECT_NEAR(warm.objective(), cold.objective(), 2e-8 * (1.0 + cold.objective()));
}

INSTANTIATE_TEST_SUITE_P(Random, QpSolverFamily, ::testing::ValuesIn(families()),
                         [](const auto& test) { return test.param.name; });

WrenchQp some_problem(unsigned seed = 7) {
  std::mt19937 rng(seed);
  return testing::random_wrench_qp({}, rng);
}

TEST(QpSolver, ManyRandomProblemsAllConverge) {
  std::mt19937 rng(20240401);
  QpSolver solver({.iteration_cap = 25, .gap = 1e-8, .stationarity = 1e-6});
  for (const NamedFamily& named : families()) {
    for (int i = 0; i < 100; ++i) {
      const WrenchQp qp = testing::random_wrench_qp(named.family, rng);
      ASSERT_EQ(solver.solve_cold(qp), QpStatus::solved)
          << named.name << " " << i << " gap " << solver.gap() << " stationarity "
          << solver.stationarity();
    }
  }
}

TEST(QpSolver, WarmStartSavesIterationsOnTheSameProblem) {
  const WrenchQp qp = some_problem();
  QpSolver solver(kTolerances);
  ASSERT_EQ(solver.solve_cold(qp), QpStatus::solved);
  const int cold = solver.iterations();
  WarmStartMap same{};
  for (std::size_t k = 0; k < same.size(); ++k) same[k] = static_cast<int>(k);
  ASSERT_EQ(solver.solve_warm(qp, same), QpStatus::solved);
  EXPECT_LT(solver.iterations(), cold);
}

TEST(QpSolver, SameProblemGivesTheSameBits) {
  const WrenchQp qp = some_problem();
  QpSolver first(kTolerances);
  QpSolver second(kTolerances);
  ASSERT_EQ(second.solve_cold(some_problem(8)), QpStatus::solved);  // another history
  ASSERT_EQ(first.solve_cold(qp), QpStatus::solved);
  ASSERT_EQ(second.solve_cold(qp), QpStatus::solved);
  EXPECT_EQ(first.iterations(), second.iterations());
  for (int k = 0; k < qp.horizon; ++k) {
    for (const core::Leg leg : core::kAllLegs) EXPECT_EQ(first.input(k, leg), second.input(k, leg));
  }
}

TEST(QpSolver, SolvingAllocatesNothing) {
  const WrenchQp qp = some_problem();
  WarmStartMap map{};
  QpSolver solver(kTolerances);
  const std::size_t before = core::allocation_count();
  const QpStatus cold = solver.solve_cold(qp);
  const QpStatus warm = solver.solve_warm(qp, map);
  const std::size_t after = core::allocation_count();
  EXPECT_EQ(cold, QpStatus::solved);
  EXPECT_EQ(warm, QpStatus::solved);
  EXPECT_EQ(after, before);
}

TEST(QpSolver, AllocationCounterCounts) {
  const std::size_t before = core::allocation_count();
  const QpSolver solver(kTolerances);
  EXPECT_GT(core::allocation_count(), before);
}

TEST(QpSolver, HorizonWithoutContactHasNothingToChoose) {
  WrenchQp qp = some_problem();
  for (WrenchQpStage& stage : qp.stages) stage.feet[0].contact = stage.feet[1].contact = false;
  QpSolver solver(kTolerances);
  ASSERT_EQ(solver.solve_cold(qp), QpStatus::solved);
  EXPECT_EQ(solver.iterations(), 0);
  for (const core::Leg leg : core::kAllLegs) EXPECT_EQ(solver.input(0, leg), FootInput::Zero());
  const testing::DenseQp dense = testing::condense(qp);
  EXPECT_NEAR(solver.objective(), static_cast<double>(dense.constant),
              1e-12 * static_cast<double>(dense.constant));
}

TEST(QpSolver, FootWithoutContactHasZeroInput) {
  std::mt19937 rng(5);
  const WrenchQp qp = testing::random_wrench_qp({.contact = ContactPattern::alternating}, rng);
  QpSolver solver(kTolerances);
  ASSERT_EQ(solver.solve_cold(qp), QpStatus::solved);
  for (int k = 0; k < qp.horizon; ++k) {
    for (const core::Leg leg : core::kAllLegs) {
      const bool contact = qp.stages[static_cast<std::size_t>(k)].feet[core::index(leg)].contact;
      EXPECT_EQ(solver.input(k, leg) == FootInput::Zero(), !contact) << "step " << k;
    }
  }
}

TEST(QpSolver, IterateIsFeasibleWhenTheCapCutsItShort) {
  const WrenchQp qp = some_problem();
  const DenseQp dense = testing::condense(qp);
  for (int cap = 1; cap <= 5; ++cap) {
    QpSolver solver({.iteration_cap = cap, .gap = 1e-12, .stationarity = 1e-12});
    ASSERT_EQ(solver.solve_cold(qp), QpStatus::iteration_limit);
    EXPECT_EQ(solver.iterations(), cap);
    const DenseVector slack = dense.A * inputs_of(solver, dense) + dense.b;
    EXPECT_GT(slack.minCoeff(), 0.0L);
  }
}

TEST(QpSolver, DoesNotStartFromAFailedSolution) {
  const WrenchQp qp = some_problem();
  QpSolver solver({.iteration_cap = 1, .gap = 1e-12, .stationarity = 1e-12});
  WarmStartMap map{};
  ASSERT_EQ(solver.solve_cold(qp), QpStatus::iteration_limit);
  ASSERT_EQ(solver.solve_warm(qp, map), QpStatus::iteration_limit);
  EXPECT_FALSE(solver.started_warm());
}

TEST(QpSolver, ConeWithoutInteriorIsInfeasible) {
  QpSolver solver(kTolerances);
  WrenchQp qp = some_problem();
  qp.cone.max_normal_force = 0.0;
  EXPECT_EQ(solver.solve_cold(qp), QpStatus::infeasible);
  qp = some_problem();
  qp.cone.upper(kMomentY) = -qp.cone.lower(kMomentY);
  EXPECT_EQ(solver.solve_cold(qp), QpStatus::infeasible);
}

TEST(QpSolver, ConeMayLieToOneSideOfZero) {
  WrenchQp qp = some_problem();
  qp.cone.upper(kMomentY) = -0.01;  // the sole touches with its front part only
  qp.cone.lower(kMomentY) = 0.06;
  QpSolver solver(kTolerances);
  ASSERT_EQ(solver.solve_cold(qp), QpStatus::solved);
  const DenseQp dense = testing::condense(qp);
  EXPECT_NEAR(solver.objective(), static_cast<double>(dense.objective(testing::solve_dense(dense))),
              2e-8 * (1.0 + solver.objective()));
}

TEST(QpSolver, HostileNumbersAreBadInput) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const auto status = [](const auto& spoil) {
    WrenchQp qp = some_problem();
    spoil(qp);
    return QpSolver(kTolerances).solve_cold(qp);
  };
  EXPECT_EQ(status([](WrenchQp&) {}), QpStatus::solved);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.horizon = 0; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.horizon = 21; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.mass = 0.0; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.x0(3) = kNaN; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.stages[9].dt = -0.01; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.stages[9].dt = kInf; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.stages[4].rpy_rate(1, 1) = kNaN; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.stages[4].inertia_inverse(2, 1) = kInf; }),
            QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.stages[4].target(7) = kNaN; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.stages[4].velocity_gain(2) = kNaN; }),
            QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.stages[2].feet[1].p_GF(0) = kNaN; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.stages[2].feet[1].reference(4) = kNaN; }),
            QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.state_weight(0) = -1.0; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.input_weight(2) = 1e-9; }), QpStatus::bad_input);
  EXPECT_EQ(status([](WrenchQp& qp) { qp.cone.upper(0) = kNaN; }), QpStatus::bad_input);
}

TEST(QpSolver, IgnoresWhatBelongsToNoContact) {
  WrenchQp qp = some_problem();
  qp.stages[2].feet[1].contact = false;
  WrenchQp spoiled = qp;
  spoiled.stages[2].feet[1].p_GF.setConstant(std::numeric_limits<double>::quiet_NaN());
  QpSolver solver(kTolerances);
  ASSERT_EQ(solver.solve_cold(qp), QpStatus::solved);
  const double objective = solver.objective();
  ASSERT_EQ(solver.solve_cold(spoiled), QpStatus::solved);
  EXPECT_EQ(solver.objective(), objective);
}

TEST(QpSolver, SurvivesNumbersThatOverflow) {
  WrenchQp qp = some_problem();
  qp.x0.setConstant(1e200);  // finite, but its cost is not
  QpSolver solver(kTolerances);
  EXPECT_EQ(solver.solve_cold(qp), QpStatus::iteration_limit);
  EXPECT_EQ(solver.solve_cold(some_problem()), QpStatus::solved);
}

}  // namespace
}  // namespace hopscotch::control
