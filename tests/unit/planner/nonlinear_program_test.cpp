#include "planner/nonlinear_program.hpp"

#include <gtest/gtest.h>

#include "planner/block_forms.hpp"

namespace hopscotch::planner {
namespace {

/// cost x y, row 0: x^2 + y, row 1 unbounded.
struct SmallLaw {
  static constexpr int kRows = 2;
  template <typename T>
  T operator()(const std::array<T, 2>& x, std::array<T, kRows>& rows) const {
    rows[0] = x[0] * x[0] + x[1];
    rows[1] = x[0];
    return x[0] * x[1];
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    lower[0] = 0.0;
    upper[0] = 1.0;
    lower[1] = -kUnbounded;
    upper[1] = kUnbounded;
  }
};

/// Two blocks that share variable 1; the second has a constant zero in front.
NonlinearProgram program() {
  std::vector<std::unique_ptr<ConstraintBlock>> blocks;
  blocks.push_back(std::make_unique<KnotBlock<SmallLaw, 2>>(SmallLaw{}, std::array<int, 2>{0, 1}));
  blocks.push_back(std::make_unique<KnotBlock<SmallLaw, 2>>(SmallLaw{}, std::array<int, 2>{1, 2}));
  blocks.push_back(
      std::make_unique<KnotBlock<SmallLaw, 2>>(SmallLaw{}, std::array<int, 2>{kNoVariable, 2}));
  return {3, std::move(blocks)};
}

TEST(NonlinearProgram, LeavesOutUnboundedRows) {
  EXPECT_EQ(program().rows(), 3);
}

TEST(NonlinearProgram, AddsUpCostsAndStacksRows) {
  const double x[3] = {1.0, 2.0, 3.0};
  Eigen::VectorXd rows;
  EXPECT_DOUBLE_EQ(program().values(x, rows), 1.0 * 2.0 + 2.0 * 3.0 + 0.0);
  EXPECT_TRUE(rows.isApprox(Eigen::Vector3d(3.0, 7.0, 3.0)));
}

TEST(NonlinearProgram, AddsUpDerivativesThatMeet) {
  const NonlinearProgram nlp = program();
  const double x[3] = {1.0, 2.0, 3.0};
  Eigen::VectorXd gradient;
  Eigen::VectorXd jacobian;
  nlp.slopes(x, gradient, jacobian);
  EXPECT_TRUE(gradient.isApprox(Eigen::Vector3d(2.0, 1.0 + 3.0, 2.0)));
  const double multipliers[3] = {0.5, 0.25, 4.0};
  Eigen::VectorXd hessian;
  nlp.curvature(x, 1.0, multipliers, hessian);
  Eigen::Matrix3d dense = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < nlp.hessian_pattern().size(); ++i) {
    const SparseEntry& at = nlp.hessian_pattern()[i];
    EXPECT_GE(at.row, at.column);
    dense(at.row, at.column) = hessian(static_cast<Eigen::Index>(i));
  }
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  expected(0, 0) = 2.0 * 0.5;
  expected(1, 0) = 1.0;
  expected(1, 1) = 2.0 * 0.25;
  expected(2, 1) = 1.0;
  EXPECT_TRUE(dense.isApprox(expected));
}

TEST(NonlinearProgram, HasNoPlaceTwice) {
  const NonlinearProgram nlp = program();
  for (const std::vector<SparseEntry>& pattern : {nlp.jacobian_pattern(), nlp.hessian_pattern()}) {
    for (std::size_t i = 1; i < pattern.size(); ++i) EXPECT_LT(pattern[i - 1], pattern[i]);
  }
}

}  // namespace
}  // namespace hopscotch::planner
