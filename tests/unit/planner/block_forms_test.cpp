#include "planner/block_forms.hpp"

#include <gtest/gtest.h>

#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::derivative_error;
using testing_support::DerivativeError;
using testing_support::kDerivativeTolerance;
using testing_support::random_point;

/// A nonlinear law of one coordinate that shows its arguments.
struct EchoLaw {
  static constexpr int kRows = 4;
  template <typename T>
  T operator()(const std::array<T, 4>& x, std::array<T, kRows>& rows) const {
    rows[0] = x[0];
    rows[1] = x[1] * x[2];
    rows[2] = x[2];
    rows[3] = x[3] * x[0];
    return x[0] * x[1] * x[2] + x[3] * x[3];
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, -1.0);
    std::fill_n(upper.begin(), kRows, 1.0);
  }
};

constexpr double kRounding = 1e-12;

TEST(StepBlock, ShowsTheLawTheMiddleOfAStepOfConstantAcceleration) {
  const StepBlock<EchoLaw, 1, StepLength::fixed> block(EchoLaw{}, {0, 1, 2, 3}, 0.2);
  // y(t) = 1 + 2 t + 3 t^2 over h = 0.2
  const std::vector<double> x{1.0, 2.0, 1.0 + 0.4 + 0.12, 2.0 + 1.2};
  std::vector<double> rows(5);
  block.values(x, rows);
  EXPECT_NEAR(rows[0], 0.0, kRounding);                // the trapezoid holds
  EXPECT_NEAR(rows[1], 1.0 + 0.2 + 0.03, kRounding);   // y at 0.1
  EXPECT_NEAR(rows[2], (2.0 + 0.6) * 6.0, kRounding);  // v at 0.1 times u
  EXPECT_NEAR(rows[3], 6.0, kRounding);                // u
  EXPECT_NEAR(rows[4], 0.2 * (1.0 + 0.2 + 0.03), kRounding);
}

TEST(StepBlock, FixedStepHasExactDerivatives) {
  const StepBlock<EchoLaw, 1, StepLength::fixed> block(EchoLaw{}, {0, 1, 2, 3}, 0.2);
  const DerivativeError error = derivative_error(block, random_point(4, 1));
  EXPECT_LT(error.slopes, kDerivativeTolerance);
  EXPECT_LT(error.curvature, kDerivativeTolerance);
}

TEST(StepBlock, FreeStepHasExactDerivatives) {
  const StepBlock<EchoLaw, 1, StepLength::free> block(EchoLaw{}, {0, 1, 2, 3, 4}, 1.4);
  std::vector<double> x = random_point(5, 2);
  x[4] = 0.3;  // a length is positive
  const DerivativeError error = derivative_error(block, x);
  EXPECT_LT(error.slopes, kDerivativeTolerance);
  EXPECT_LT(error.curvature, kDerivativeTolerance);
}

TEST(StepBlock, FreeStepIsAShareOfItsVariable) {
  const StepBlock<EchoLaw, 1, StepLength::free> share(EchoLaw{}, {0, 1, 2, 3, 4}, 0.5);
  const StepBlock<EchoLaw, 1, StepLength::fixed> fixed(EchoLaw{}, {0, 1, 2, 3}, 0.1);
  const std::vector<double> x{0.3, -0.2, 0.5, 0.7, 0.2};
  std::vector<double> a(5);
  std::vector<double> b(5);
  share.values(x, a);
  fixed.values(std::span(x).first(4), b);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(a[i], b[i], kRounding);
}

}  // namespace
}  // namespace hopscotch::planner
