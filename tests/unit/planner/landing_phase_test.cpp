#include "planner/landing_phase.hpp"

#include "tests/unit/planner/phase_fixture.hpp"

namespace hopscotch::planner {
namespace {

using LandingPhase = testing_support::PhaseTest;

TEST_F(LandingPhase, HasExactDerivatives) {
  add_landing(model_, task_, layout_, blocks_);
  expect_exact_derivatives();
}

/// A soft touchdown: the rates before are those of a standing robot.
TEST_F(LandingPhase, TouchdownWithoutImpactSatisfiesTheLawAndCostsNothing) {
  const model::LinkArray<double> a = links_from_coordinates(-1.0, -1.9, -0.2, 0.0);
  const model::LinkArray<double> w = links_from_coordinates(1.0, -4.0, -2.0, 0.0);
  const model::PlanarVector<double> com = model_.dynamics.com(a);
  const model::PlanarVector<double> velocity = model_.dynamics.com_velocity(a, w);
  constexpr double kStep = 0.02;
  constexpr double kKnots = 10.0;
  constexpr double kTime = kKnots * kStep;
  const model::PlanarVector<double> ankle{0.39, 0.14};
  const TouchdownLaw law{model_.dynamics, kKnots, ankle, 1.2, 0.8, 2.0};
  const double vz = velocity.z + model::kGravity * kTime;
  const std::array<double, 15> x{
      -1.0,
      -1.9,
      -0.2,
      1.0,
      -4.0,
      -2.0,
      0.0,
      1.0,
      -4.0,
      -2.0,
      ankle.x + com.x - velocity.x * kTime,
      ankle.z + com.z - vz * kTime + 0.5 * model::kGravity * kTime * kTime,
      velocity.x,
      vz,
      kStep};
  std::array<double, TouchdownLaw::kRows> rows{};
  std::array<double, TouchdownLaw::kRows> lower{};
  std::array<double, TouchdownLaw::kRows> upper{};
  constexpr double kRounding = 1e-12;
  EXPECT_NEAR(law(x, rows), 0.0, kRounding);
  law.bounds(lower, upper);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    EXPECT_GE(rows[r], lower[r] - kRounding) << r;
    EXPECT_LE(rows[r], upper[r] + kRounding) << r;
  }
}

TEST_F(LandingPhase, ShortStepsComeFirstAndKeepTheMean) {
  double sum = 0.0;
  const int steps = model_.config.steps.landing;
  for (int k = 0; k < steps; ++k) sum += model_.config.landing_share(k);
  EXPECT_NEAR(sum, steps, 1e-9);
  EXPECT_LT(model_.config.landing_share(0), model_.config.landing_share(steps - 1));
}

}  // namespace
}  // namespace hopscotch::planner
