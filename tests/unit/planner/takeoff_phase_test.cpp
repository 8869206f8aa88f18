#include "planner/takeoff_phase.hpp"

#include "tests/unit/planner/phase_fixture.hpp"

namespace hopscotch::planner {
namespace {

using TakeoffPhase = testing_support::PhaseTest;

TEST_F(TakeoffPhase, HasExactDerivatives) {
  add_takeoff(model_, task_, layout_, blocks_);
  expect_exact_derivatives();
}

TEST_F(TakeoffPhase, StandingStillSatisfiesEveryRow) {
  add_takeoff(model_, task_, layout_, blocks_);
  const std::array<double, kFlightDof> y = coordinates_from_links(task_.start.pitch);
  const ConstraintBlock& step = *blocks_.front();
  const std::size_t rows = static_cast<std::size_t>(step.rows());
  std::vector<double> value(rows);
  std::vector<double> lower(rows);
  std::vector<double> upper(rows);
  step.values(std::vector<double>{y[0], y[1], y[2], 0, 0, 0, y[0], y[1], y[2], 0, 0, 0}, value);
  step.bounds(lower, upper);
  for (std::size_t r = 0; r < rows; ++r) {
    EXPECT_GE(value[r], lower[r]) << r;
    EXPECT_LE(value[r], upper[r]) << r;
  }
}

TEST_F(TakeoffPhase, TerrainBehindLimitsHowFarTheKneesMayGoBack) {
  constexpr double kSole = 0.04;  // [m]
  const ShankRange flat = shank_range(model_, task_.terrain, {0.0, kSole});
  EXPECT_NEAR(flat.lower, -model_.config.shank_pitch_max, 0.01);
  // Standing 25 cm below an edge that is 15 cm behind the ankle.
  const PlanarTask drop = testing_support::task(model_, 0.30, -0.25);
  const ShankRange close = shank_range(model_, drop.terrain, {0.27, -0.25 + kSole});
  EXPECT_GT(close.lower, flat.lower + 0.1);
  const model::PlanarVector<double> knee =
      model_.dynamics.knee(model::LinkArray<double>{0.0, close.lower, 0.0, 0.0});
  EXPECT_GE(-0.25 + kSole + knee.z,
            drop.terrain.at(0.27 + knee.x).height + model_.config.knee_clearance);
}

TEST_F(TakeoffPhase, AnEdgeBetweenAnkleAndKneeLimitsTheShankToo) {
  constexpr double kSole = 0.04;    // [m]
  constexpr double kAnkle = 0.225;  // 11 cm beyond the edge of a drop of 15 cm [m]
  const PlanarTask drop = testing_support::task(model_, 0.25, -0.15);
  const double leant = task_.final_posture[model::kShank];
  const model::PlanarVector<double> ankle{kAnkle, -0.15 + kSole};
  const model::PlanarVector<double> knee =
      model_.dynamics.knee(model::LinkArray<double>{0.0, leant, 0.0, 0.0});
  EXPECT_GT(ankle.z + knee.z, model_.config.knee_clearance) << "the knee itself is well above";
  EXPECT_LT(shank_room(model_, drop.terrain, ankle, leant, model_.robot.shank_radius), 0.0);
  const ShankRange range = shank_range(model_, drop.terrain, ankle);
  EXPECT_GT(range.lower, leant);
  EXPECT_GT(shank_room(model_, drop.terrain, ankle, range.lower, model_.robot.shank_radius), 0.0);
}

TEST_F(TakeoffPhase, NoPointOfAShankIsNearerToTheGroundThanItsRoom) {
  constexpr double kSole = 0.04;            // [m]
  constexpr double kRadius = 0.02;          // [m]
  constexpr double kFoot = 0.25;            // share of the shank that is no part of the question
  constexpr double kBetweenPoints = 0.002;  // what is missed between the points looked at [m]
  const PlanarTask drop = testing_support::task(model_, 0.30, -0.15);
  const model::PlanarVector<double> ankle{0.24, -0.15 + kSole};
  for (double pitch = -1.0; pitch <= 1.0; pitch += 0.05) {
    const model::PlanarVector<double> knee =
        model_.dynamics.knee(model::LinkArray<double>{0.0, pitch, 0.0, 0.0});
    double nearest = kUnbounded;
    for (double share = kFoot; share <= 1.0; share += 0.01) {
      for (double aside = -kRadius; aside <= kRadius; aside += 0.1 * kRadius) {
        const double x = ankle.x + share * knee.x + aside - SmoothTerrain::kEdgeDoubt;
        const double below = std::sqrt(std::max(0.0, kRadius * kRadius - aside * aside));
        nearest = std::min(nearest, ankle.z + share * knee.z - below - drop.terrain.at(x).height);
      }
    }
    const double room = shank_room(model_, drop.terrain, ankle, pitch, kRadius);
    EXPECT_GE(room, nearest - 1e-9) << pitch;
    EXPECT_LE(room, nearest + 0.05 * std::abs(pitch) + kBetweenPoints) << pitch;
  }
}

TEST_F(TakeoffPhase, AShankOnOpenGroundHasTheRoomOfItsLowestPoint) {
  constexpr double kRadius = 0.015;  // [m]
  const double room = shank_room(model_, task_.terrain, {0.0, 0.04}, 0.0, kRadius);
  const double lowest = 0.04 + 0.25 * model_.dynamics.chain().shank.length - kRadius;
  EXPECT_NEAR(room, lowest, 1e-9);
}

}  // namespace
}  // namespace hopscotch::planner
