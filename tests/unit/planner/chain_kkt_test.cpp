#include "planner/chain_kkt.hpp"

#include "tests/unit/planner/chain_fixture.hpp"

namespace hopscotch::planner::testing_support {
namespace {

class ChainKktTest : public ChainTest {
 protected:
  /// The same Newton equations from the blocks: residual of stationarity for each free variable.
  [[nodiscard]] Eigen::VectorXd stationarity(const Eigen::VectorXd& x, const KktInput& input,
                                             const Eigen::VectorXd& dx,
                                             const Eigen::VectorXd& multipliers) const {
    Eigen::VectorXd sum;
    Eigen::VectorXd jacobian;
    program_.slopes(x.data(), sum, jacobian);
    sum *= ChainProblem::kCostScale;
    Eigen::VectorXd along = Eigen::VectorXd::Zero(program_.rows());
    const auto entries = [&](const auto& visit) {
      for (std::size_t e = 0; e < program_.jacobian_pattern().size(); ++e) {
        visit(program_.jacobian_pattern()[e], jacobian(static_cast<Eigen::Index>(e)));
      }
    };
    entries([&](const SparseEntry& at, double v) { along(at.row) += v * dx(at.column); });
    const Eigen::VectorXd slope = places_.gather(*input.slot_slopes, multipliers);
    const Eigen::VectorXd weight =
        places_.gather(*input.slot_weights, Eigen::VectorXd::Zero(multipliers.size()));
    entries([&](const SparseEntry& at, double v) {
      sum(at.column) += v * (slope(at.row) + weight(at.row) * along(at.row));
    });
    Eigen::VectorXd hessian;
    const Eigen::VectorXd rows = places_.gather(slot_multipliers_, equality_multipliers_);
    program_.curvature(x.data(), ChainProblem::kCostScale, rows.data(), hessian);
    for (std::size_t e = 0; e < program_.hessian_pattern().size(); ++e) {
      const SparseEntry& at = program_.hessian_pattern()[e];
      const double value = hessian(static_cast<Eigen::Index>(e));
      sum(at.row) += value * dx(at.column);
      if (at.row != at.column) sum(at.column) += value * dx(at.row);
    }
    for (int i = 0; i < problem_.layout().variables(); ++i) {
      const int slot = problem_.layout().variable(i);
      const double size = problem_.sizes()(i);
      sum(i) += (*input.slot_slopes)(slot) +
                ((*input.slot_weights)(slot) + input.regularisation / (size * size)) * dx(i);
      if (problem_.is_fixed(i)) sum(i) = 0.0;
    }
    return sum;
  }

  Eigen::VectorXd slot_multipliers_ = 0.1 * slot_noise(7);
  Eigen::VectorXd equality_multipliers_ = 0.1 * noise(problem_.layout().equalities(), 8);
};

TEST_P(ChainKktTest, SolvesTheNewtonEquationsOfTheBlocks) {
  const Eigen::VectorXd x = noisy_point(9);
  slot_multipliers_.tail(problem_.layout().variables()).setZero();
  problem_.expand(x, slot_multipliers_, equality_multipliers_, terms_);
  const Eigen::VectorXd weights = slot_noise(10).cwiseAbs();
  const Eigen::VectorXd slopes = slot_noise(11);
  const Eigen::VectorXd equalities = 0.1 * noise(problem_.layout().equalities(), 12);
  const KktInput input{&terms_, &weights, &slopes, &equalities, 1.0, 100.0};
  ChainKkt kkt(problem_.layout());
  Eigen::VectorXd dx = Eigen::VectorXd::Zero(x.size());
  Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(problem_.layout().equalities());
  ASSERT_TRUE(kkt.solve(problem_, input, dx, multipliers));

  Eigen::VectorXd gradient;
  Eigen::VectorXd jacobian;
  program_.slopes(x.data(), gradient, jacobian);
  Eigen::VectorXd left = places_.gather(Eigen::VectorXd::Zero(weights.size()), equalities);
  for (std::size_t e = 0; e < program_.jacobian_pattern().size(); ++e) {
    const SparseEntry& at = program_.jacobian_pattern()[e];
    left(at.row) += jacobian(static_cast<Eigen::Index>(e)) * dx(at.column);
  }
  for (int r = 0; r < program_.rows(); ++r) {
    const RowPlace& place = places_.list()[static_cast<std::size_t>(r)];
    EXPECT_NEAR(place.is_equality ? left(r) : 0.0, 0.0, 1e-9) << "equality " << place.at;
  }
  const Eigen::VectorXd sum = stationarity(x, input, dx, multipliers);
  const double scale = multipliers.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < sum.size(); ++i) {
    EXPECT_NEAR(sum(i), 0.0, 1e-9 * (1.0 + scale)) << "variable " << i;
  }
}

TEST_P(ChainKktTest, RefusesAHessianThatIsNotPositive) {
  const Eigen::VectorXd x = noisy_point(13);
  problem_.expand(x, slot_multipliers_, equality_multipliers_, terms_);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(problem_.layout().slots());
  const Eigen::VectorXd equalities = Eigen::VectorXd::Zero(problem_.layout().equalities());
  const KktInput input{&terms_, &none, &none, &equalities, 1.0, -1e3};
  ChainKkt kkt(problem_.layout());
  Eigen::VectorXd dx = Eigen::VectorXd::Constant(x.size(), 7.0);
  Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(equalities.size());
  EXPECT_FALSE(kkt.solve(problem_, input, dx, multipliers));
  EXPECT_EQ(dx, Eigen::VectorXd::Constant(x.size(), 7.0));
}

INSTANTIATE_TEST_SUITE_P(Jumps, ChainKktTest,
                         testing::Values(ChainCase{0.40, 0.10}, ChainCase{0.35, -0.20},
                                         ChainCase{0.40, 0.0, 12}, ChainCase{0.40, 0.0, 3},
                                         ChainCase{0.40, 0.10, 0, true}));

}  // namespace
}  // namespace hopscotch::planner::testing_support
