#include "planner/flight_phase.hpp"

#include "tests/unit/planner/phase_fixture.hpp"

namespace hopscotch::planner {
namespace {

using FlightPhase = testing_support::PhaseTest;

TEST_F(FlightPhase, HasExactDerivatives) {
  add_flight(model_, task_, layout_, blocks_);
  expect_exact_derivatives();
}

TEST(Ballistic, FallsWithGravityAlone) {
  const Ballistic<double> flight{0.1, 0.4, 0.9, 1.2, 0.02};
  constexpr double kKnot = 7.0;
  const double t = kKnot * flight.step;
  EXPECT_NEAR(flight.com(kKnot).x, 0.1 + 0.9 * t, 1e-12);
  EXPECT_NEAR(flight.com(kKnot).z, 0.4 + 1.2 * t - 0.5 * model::kGravity * t * t, 1e-12);
  EXPECT_NEAR(flight.velocity(kKnot).z, 1.2 - model::kGravity * t, 1e-12);
}

TEST_F(FlightPhase, LiftoffTakesOverPositionVelocityAndMomentum) {
  const model::PlanarVector<double> ankle{-0.01, 0.04};
  const LiftoffLaw law{model_.dynamics, ankle};
  const model::LinkArray<double> a = links_from_coordinates(-0.7, -1.5, 0.3, 0.0);
  const model::LinkArray<double> w = links_from_coordinates(6.0, 7.0, -2.0, 0.0);
  const model::PlanarVector<double> com = model_.dynamics.com(a);
  const model::PlanarVector<double> velocity = model_.dynamics.com_velocity(a, w);
  const std::array<double, 11> x{-0.7,
                                 -1.5,
                                 0.3,
                                 6.0,
                                 7.0,
                                 -2.0,
                                 ankle.x + com.x,
                                 ankle.z + com.z,
                                 velocity.x,
                                 velocity.z,
                                 model_.dynamics.centroidal_momentum(a, w)};
  std::array<double, LiftoffLaw::kRows> rows{};
  std::array<double, LiftoffLaw::kRows> lower{};
  std::array<double, LiftoffLaw::kRows> upper{};
  law(x, rows);
  law.bounds(lower, upper);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    EXPECT_NEAR(rows[r], lower[r], 1e-12);
    EXPECT_EQ(lower[r], upper[r]);
  }
}

TEST_F(FlightPhase, ClearanceIsMeasuredFromTheTerrainBelowEachPoint) {
  const ClearanceLaw law{model_.dynamics, task_.terrain, 3.0, 0.05, 0.03};
  const model::LinkArray<double> a = links_from_coordinates(-0.8, -1.6, 0.2, 0.1);
  const Ballistic<double> flight{0.05, 0.45, 1.0, 1.3, 0.02};
  const std::array<double, 9> x{-0.8,     -1.6,      0.2,       0.1,        flight.x,
                                flight.z, flight.vx, flight.vz, flight.step};
  std::array<double, ClearanceLaw::kRows> rows{};
  law(x, rows);
  const model::PlanarVector<double> centre = flight.com(3.0);
  const model::PlanarVector<double> com = model_.dynamics.com(a);
  const model::PlanarVector<double> toe = model_.dynamics.toe(a);
  const double toe_x = centre.x - com.x + toe.x;
  EXPECT_NEAR(rows[0], centre.z - com.z + toe.z - task_.terrain.at(toe_x).height, 1e-12);
  // The shank looks back for an edge that it follows over.
  const model::PlanarVector<double> knee = model_.dynamics.knee(a);
  for (std::size_t i = 0; i < ClearanceLaw::kShankShares.size(); ++i) {
    const double share = ClearanceLaw::kShankShares[i];
    const double x_back = centre.x - com.x + share * knee.x - SmoothTerrain::kEdgeDoubt;
    EXPECT_NEAR(rows[ClearanceLaw::kFootRows + i],
                centre.z - com.z + share * knee.z - task_.terrain.at(x_back).height, 1e-12);
  }
}

TEST(ClearanceProfile, AsksForNothingAtTheEnds) {
  EXPECT_NEAR(clearance_profile(0.08, 0.0), 0.0, 1e-15);
  EXPECT_NEAR(clearance_profile(0.08, 0.5), 0.08, 1e-15);
  EXPECT_NEAR(clearance_profile(0.08, 1.0), 0.0, 1e-15);
}

}  // namespace
}  // namespace hopscotch::planner
