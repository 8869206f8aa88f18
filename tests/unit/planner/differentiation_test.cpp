#include "planner/differentiation.hpp"

#include <gtest/gtest.h>

namespace hopscotch::planner {
namespace {

constexpr double kRounding = 1e-13;

/// f = sin(x) y^2 + x cos(y) - 3 x y / 2 + 1
template <typename T>
T sample(const T& x, const T& y) {
  using std::cos;
  using std::sin;
  return sin(x) * (y * y) + x * cos(y) - 1.5 * x * y + 1.0;
}

TEST(Differentiation, FirstOrderGivesTheGradient) {
  using T = FirstOrder<2>;
  const double x = 0.4;
  const double y = -0.7;
  const T f = sample(T::variable(x, 0), T::variable(y, 1));
  EXPECT_NEAR(f.value, sample(x, y), kRounding);
  EXPECT_NEAR(f.gradient[0], std::cos(x) * y * y + std::cos(y) - 1.5 * y, kRounding);
  EXPECT_NEAR(f.gradient[1], 2.0 * std::sin(x) * y - x * std::sin(y) - 1.5 * x, kRounding);
}

TEST(Differentiation, SecondOrderGivesGradientAndHessian) {
  using T = SecondOrder<2>;
  const double x = 0.4;
  const double y = -0.7;
  const T f = sample(T::variable(x, 0), T::variable(y, 1));
  EXPECT_NEAR(f.gradient[0], std::cos(x) * y * y + std::cos(y) - 1.5 * y, kRounding);
  EXPECT_NEAR(f.hessian[0], -std::sin(x) * y * y, kRounding);
  EXPECT_NEAR(f.hessian[1], 2.0 * std::cos(x) * y - std::sin(y) - 1.5, kRounding);
  EXPECT_NEAR(f.hessian[2], 2.0 * std::sin(x) - x * std::cos(y), kRounding);
}

TEST(Differentiation, ComposeFollowsTheChainRule) {
  using T = SecondOrder<1>;
  const T x = T::variable(0.3, 0);
  const T inner = x * x;
  const double u = inner.value;
  const T f = compose(inner, std::exp(u), std::exp(u), std::exp(u));
  EXPECT_NEAR(f.gradient[0], std::exp(u) * 0.6, kRounding);
  EXPECT_NEAR(f.hessian[0], std::exp(u) * (0.36 + 2.0), kRounding);
}

}  // namespace
}  // namespace hopscotch::planner
