#include "perception/one_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/perception/flat_map.hpp"

namespace hopscotch::perception {
namespace {

using core::CellState;
using core::TerrainProfile;

/// Seen edges may be off by the grid and by what noise adds [m].
constexpr double kEdgeTolerance = 0.015;

core::OneStepTerrain seen_from_origin(const test::Course& course, std::uint32_t seed) {
  const core::RobotState state = test::standing_at(course, 0.0, 0.0, 0.0);
  TerrainMapper mapper(test::perception_config(), test::hector());
  mapper.anchor_support(state);
  test::look(course, state, 8, seed, mapper);
  return test::preview(mapper, state);
}

TEST(OneStep, StanceIsTheMidPointOfTheSoles) {
  const test::Course course{.blocks = {}, .yaw = 0.4};
  const core::RobotState state = test::standing_at(course, 0.3, 0.07, 0.0);
  const StancePose stance = stance_pose(test::perception_config().one_step, test::hector(), state);
  EXPECT_NEAR(stance.p_WS.x(), 0.3 * std::cos(0.4), 1e-6);
  EXPECT_NEAR(stance.p_WS.y(), 0.3 * std::sin(0.4), 1e-6);
  EXPECT_NEAR(stance.p_WS.z(), 0.07, 1e-6);
  EXPECT_NEAR(stance.heading, 0.4, 1e-6);
  EXPECT_NEAR(stance.half_stance, 0.098, 1e-6);
}

TEST(OneStep, LevelGroundIsCoveredAndWithoutEdges) {
  const core::OneStepTerrain terrain = seen_from_origin({.blocks = {{-1.0, 5.0, 0.0}}}, 1);
  EXPECT_EQ(terrain.edge_count, 0U);
  EXPECT_EQ(terrain.gap_count, 0U);
  EXPECT_GT(terrain.coverage, 0.8);
  for (double x = 0.30; x < 1.2; x += 0.05) {
    const std::size_t i = static_cast<std::size_t>(TerrainProfile::sample(x));
    EXPECT_EQ(terrain.profile.state[i], CellState::observed) << x;
    EXPECT_NEAR(terrain.profile.mean[i], 0.0, 0.004) << x;
    EXPECT_LT(terrain.profile.upper[i], 0.02) << x;
  }
  const std::size_t blind = static_cast<std::size_t>(TerrainProfile::sample(0.16));
  EXPECT_EQ(terrain.profile.state[blind], CellState::occluded);
  EXPECT_LT(terrain.profile.upper[blind], 0.02);
}

TEST(OneStep, EdgesOfStonesAreFoundWithinOneCellAtAnyAlignmentAndHeading) {
  for (const double yaw : {0.0, 0.35, -1.9}) {
    for (const double shift : {0.0, 0.004, 0.008, 0.012}) {
      const double near = 0.42 + shift;
      const double far = 0.62 + shift;
      const core::OneStepTerrain terrain =
          seen_from_origin({.blocks = {{-1.0, near, 0.0}, {far, 2.5, 0.0}}, .yaw = yaw}, 7);
      SCOPED_TRACE(testing::Message() << "yaw " << yaw << " shift " << shift);
      ASSERT_EQ(terrain.gap_count, 1U);
      EXPECT_NEAR(terrain.gaps[0].near_x, near, kEdgeTolerance);
      EXPECT_NEAR(terrain.gaps[0].far_x, far, kEdgeTolerance);
      EXPECT_GT(terrain.gaps[0].far_x - terrain.gaps[0].near_x, far - near - 0.015)
          << "a gap must not look narrower by more than one cell";
    }
  }
}

TEST(OneStep, StepHeightsAreMeasuredToHalfACentimetre) {
  for (const double step : {0.05, 0.10, 0.20}) {
    const core::OneStepTerrain terrain =
        seen_from_origin({.blocks = {{-1.0, 0.5, 0.0}, {0.5, 2.5, step}}}, 3);
    ASSERT_EQ(terrain.edge_count, 1U) << step;
    EXPECT_EQ(terrain.edges[0].kind, core::EdgeKind::up);
    EXPECT_NEAR(terrain.edges[0].step, step, 0.005);
    EXPECT_NEAR(terrain.edges[0].x, 0.5, kEdgeTolerance);
  }
}

TEST(OneStep, GroundHiddenBehindADropIsBoundedByTheRayNotObserved) {
  const core::OneStepTerrain terrain =
      seen_from_origin({.blocks = {{-1.0, 0.6, 0.0}, {0.6, 3.0, -0.25}}}, 5);
  const std::size_t hidden = static_cast<std::size_t>(TerrainProfile::sample(0.68));
  EXPECT_EQ(terrain.profile.state[hidden], CellState::occluded);
  EXPECT_TRUE(std::isnan(terrain.profile.mean[hidden]));
  EXPECT_LT(terrain.profile.upper[hidden], 0.01);
  EXPECT_GT(terrain.profile.upper[hidden], -0.25);
  const std::size_t floor = static_cast<std::size_t>(TerrainProfile::sample(1.2));
  EXPECT_NEAR(terrain.profile.mean[floor], -0.25, 0.01);
}

TEST(OneStep, EmptyMapIsUnseenEverywhere) {
  const OneStepConfig config = test::perception_config().one_step;
  const core::RobotState state = test::standing_at({}, 0.0, 0.0, 0.0);
  const core::OneStepTerrain terrain =
      one_step_terrain(config, test::unseen_map(), stance_pose(config, test::hector(), state));
  EXPECT_EQ(terrain.coverage, 0.0);
  EXPECT_EQ(terrain.edge_count, 0U);
  for (const CellState state_of_sample : terrain.profile.state) {
    EXPECT_EQ(state_of_sample, CellState::never_seen);
  }
}

}  // namespace
}  // namespace hopscotch::perception
