#include "planner/chain_problem.hpp"

#include "tests/unit/planner/chain_fixture.hpp"

namespace hopscotch::planner::testing_support {
namespace {

/// Both sides compute with the same formulas in another order.
constexpr double kRounding = 1e-9;

class ChainProblemTest : public ChainTest {
 protected:
  Eigen::VectorXd slots_ = Eigen::VectorXd::Zero(problem_.layout().slots());
  Eigen::VectorXd equalities_ = Eigen::VectorXd::Zero(problem_.layout().equalities());
};

TEST_P(ChainProblemTest, HasTheBoundsOfTheBlocks) {
  ASSERT_EQ(static_cast<int>(places_.list().size()), program_.rows());
  for (int r = 0; r < program_.rows(); ++r) {
    const RowPlace& place = places_.list()[static_cast<std::size_t>(r)];
    const double lower = program_.row_lower()(r);
    const double upper = program_.row_upper()(r);
    EXPECT_EQ(place.is_equality, lower == upper) << "row " << r;
    if (place.is_equality) continue;
    EXPECT_EQ(problem_.lower()(place.at), lower) << "row " << r;
    EXPECT_EQ(problem_.upper()(place.at), upper) << "row " << r;
  }
}

TEST_P(ChainProblemTest, HasTheValuesOfTheBlocks) {
  const Eigen::VectorXd x = noisy_point(1);
  Eigen::VectorXd rows;
  const double cost = program_.values(x.data(), rows);
  EXPECT_NEAR(problem_.values(x, slots_, equalities_), ChainProblem::kCostScale * cost,
              kRounding * cost);
  const Eigen::VectorXd ours = places_.gather(slots_, equalities_);
  for (int r = 0; r < program_.rows(); ++r) {
    const bool equality = places_.list()[static_cast<std::size_t>(r)].is_equality;
    const double target = equality ? program_.row_lower()(r) : 0.0;
    EXPECT_NEAR(ours(r), rows(r) - target, kRounding * (1.0 + std::abs(rows(r)))) << "row " << r;
  }
}

TEST_P(ChainProblemTest, HasTheGradientOfTheBlocks) {
  const Eigen::VectorXd x = noisy_point(2);
  slots_ = slot_noise(3);
  slots_.tail(problem_.layout().variables()).setZero();
  equalities_ = noise(problem_.layout().equalities(), 4);
  problem_.expand(x, slots_, equalities_, terms_);
  Eigen::VectorXd gradient(x.size());
  problem_.gradient(terms_, slots_, equalities_, gradient);
  Eigen::VectorXd expected;
  Eigen::VectorXd jacobian;
  program_.slopes(x.data(), expected, jacobian);
  expected *= ChainProblem::kCostScale;
  const Eigen::VectorXd weights = places_.gather(slots_, equalities_);
  for (std::size_t e = 0; e < program_.jacobian_pattern().size(); ++e) {
    const SparseEntry& entry = program_.jacobian_pattern()[e];
    expected(entry.column) += weights(entry.row) * jacobian(static_cast<Eigen::Index>(e));
  }
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(gradient(i), expected(i), kRounding * (1.0 + expected.cwiseAbs().maxCoeff()))
        << "variable " << i;
  }
}

TEST_P(ChainProblemTest, HasTheSlopesOfTheBlocks) {
  const Eigen::VectorXd x = noisy_point(5);
  problem_.expand(x, slots_, equalities_, terms_);
  Eigen::VectorXd direction = noise(static_cast<int>(x.size()), 6);
  direction(x.size() - 1) = 0.0;
  for (int i = 0; i < problem_.layout().variables(); ++i) {
    if (problem_.is_fixed(i)) direction(i) = 0.0;
  }
  problem_.slots_along(terms_, direction, slots_);
  Eigen::VectorXd gradient;
  Eigen::VectorXd jacobian;
  program_.slopes(x.data(), gradient, jacobian);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(program_.rows());
  for (std::size_t e = 0; e < program_.jacobian_pattern().size(); ++e) {
    const SparseEntry& entry = program_.jacobian_pattern()[e];
    expected(entry.row) += jacobian(static_cast<Eigen::Index>(e)) * direction(entry.column);
  }
  for (int r = 0; r < program_.rows(); ++r) {
    const RowPlace& place = places_.list()[static_cast<std::size_t>(r)];
    if (place.is_equality) continue;
    EXPECT_NEAR(slots_(place.at), expected(r), kRounding * (1.0 + std::abs(expected(r))))
        << "row " << r;
  }
}

INSTANTIATE_TEST_SUITE_P(Jumps, ChainProblemTest,
                         testing::Values(ChainCase{0.40, 0.10}, ChainCase{0.35, -0.20},
                                         ChainCase{0.40, 0.0, 12}, ChainCase{0.40, 0.0, 3},
                                         ChainCase{0.40, 0.10, 0, true}));

}  // namespace
}  // namespace hopscotch::planner::testing_support
