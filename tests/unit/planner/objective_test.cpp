#include "planner/objective.hpp"

#include <gtest/gtest.h>

#include "planner/block_forms.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

const model::LinkArray<double> kPosture{0.0, -0.8, 0.8, 0.2};

TEST(StepObjective, CostsNothingAtRestInTheFinalPostureWithoutTorque) {
  const StepObjective objective({1.0, 2.0, 3.0, 4.0, 5.0}, 0.25, kPosture);
  EXPECT_DOUBLE_EQ(objective(kPosture, {}, {}, model::PlanarJoints<double>{0.0, 0.0, 0.0}), 0.0);
}

TEST(StepObjective, WeighsEachTermByTheShareOfTheStep) {
  const StepObjective objective({1.0, 2.0, 3.0, 4.0, 5.0}, 0.25, kPosture);
  model::LinkArray<double> a = kPosture;
  a[model::kTrunk] += 0.1;  // hip angle and trunk pitch change
  const model::LinkArray<double> w{0.0, 0.0, 0.0, 2.0};
  const model::LinkArray<double> u{0.0, 3.0, 0.0, 0.0};
  const double cost = objective(a, w, u, model::PlanarJoints<double>{1.0, 2.0, 0.0});
  EXPECT_NEAR(cost, 0.25 * (1.0 * 0.01 + 2.0 * 4.0 + 3.0 * 5.0 + 4.0 * 9.0 + 5.0 * 0.01), 1e-12);
}

TEST(SmoothnessLaw, ConstantAccelerationCostsNothing) {
  const SmoothnessLaw law{2.0, 0.02, 0.01};
  std::array<double, 0> none{};
  EXPECT_NEAR(law(std::array<double, 3>{1.0, 1.2, 1.3}, none), 0.0, 1e-20);
  EXPECT_NEAR(law(std::array<double, 3>{1.0, 1.2, 1.4}, none), 2.0 * 100.0, 1e-9);
}

TEST(SmoothnessLaw, HasExactDerivatives) {
  const KnotBlock<SmoothnessLaw, 3> block(SmoothnessLaw{2.0, 0.5, 0.3}, {0, 1, 2});
  const testing_support::DerivativeError error =
      testing_support::derivative_error(block, testing_support::random_point(3, 3));
  EXPECT_LT(error.slopes, testing_support::kDerivativeTolerance);
  EXPECT_LT(error.curvature, testing_support::kDerivativeTolerance);
}

}  // namespace
}  // namespace hopscotch::planner
