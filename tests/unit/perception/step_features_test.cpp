#include "perception/step_features.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "perception/edge_lines.hpp"
#include "tests/unit/perception/flat_map.hpp"

namespace hopscotch::perception {
namespace {

using core::EdgeKind;

constexpr double kHalfCell = 0.0075 + 0.0025;  // grid plus half a slice [m]

class StepFeaturesTest : public ::testing::Test {
 protected:
  core::OneStepTerrain features(const test::Course& course) {
    return features(test::known_map(course));
  }
  core::OneStepTerrain features(const core::TerrainMap& map) {
    const std::vector<Slice> slices = cut_slices(config_, map, stance_);
    DividedLine line{.treads = find_treads(config_, slices), .breaks = {}};
    line.breaks = find_breaks(map, stance_, line.treads);
    treads_ = line.treads;
    core::OneStepTerrain terrain;
    step_sigmas_ = list_features(config_, slices, line, terrain);
    return terrain;
  }

  OneStepConfig config_ = test::perception_config().one_step;
  StancePose stance_{
      .p_WS = {0.0, 0.0, 0.0}, .heading = 0.0, .half_stance = 0.098, .track_half_width = 0.04};
  std::vector<Tread> treads_;
  std::vector<double> step_sigmas_;
};

TEST_F(StepFeaturesTest, LevelGroundHasNone) {
  const core::OneStepTerrain terrain = features({.blocks = {{-1.0, 3.0, 0.0}}});
  EXPECT_EQ(terrain.edge_count, 0U);
  EXPECT_EQ(terrain.gap_count, 0U);
  EXPECT_EQ(treads_.size(), 1U);
}

TEST_F(StepFeaturesTest, GapHasTwoEdgesAndAWidth) {
  const core::OneStepTerrain terrain = features({.blocks = {{-1.0, 0.40, 0.0}, {0.60, 3.0, 0.0}}});
  ASSERT_EQ(terrain.gap_count, 1U);
  EXPECT_NEAR(terrain.gaps[0].near_x, 0.40, kHalfCell);
  EXPECT_NEAR(terrain.gaps[0].far_x, 0.60, kHalfCell);
  EXPECT_GT(terrain.gaps[0].sigma, 0.0);
  ASSERT_EQ(terrain.edge_count, 2U);
  EXPECT_EQ(terrain.edges[0].kind, EdgeKind::gap_near);
  EXPECT_EQ(terrain.edges[1].kind, EdgeKind::gap_far);
}

TEST_F(StepFeaturesTest, StepsUpAndDownAreEdgesWithTheirHeight) {
  const core::OneStepTerrain terrain =
      features({.blocks = {{-1.0, 0.40, 0.0}, {0.40, 0.90, 0.12}, {0.90, 3.0, -0.05}}});
  ASSERT_EQ(terrain.edge_count, 2U);
  EXPECT_EQ(terrain.edges[0].kind, EdgeKind::up);
  EXPECT_NEAR(terrain.edges[0].x, 0.40, kHalfCell);
  EXPECT_NEAR(terrain.edges[0].step, 0.12, 1e-6);
  EXPECT_EQ(terrain.edges[1].kind, EdgeKind::down);
  EXPECT_NEAR(terrain.edges[1].x, 0.90, kHalfCell);
  EXPECT_NEAR(terrain.edges[1].step, -0.17, 1e-6);
  EXPECT_EQ(terrain.gap_count, 0U);
}

TEST_F(StepFeaturesTest, AStepFromWhatTheSolesKnowIsLessSureThanOneThatWasSeen) {
  const test::Course course{.blocks = {{-1.0, 0.20, 0.0}, {0.32, 3.0, 0.06}}};
  core::TerrainMap map = test::known_map(course);
  const core::OneStepTerrain seen = features(map);
  ASSERT_EQ(seen.edge_count, 2U);
  const double sure = step_sigmas_[1];
  test::set_stretch(map, 0.10, 0.28, {.upper = std::numeric_limits<float>::infinity()});
  const core::OneStepTerrain guessed = features(map);
  ASSERT_EQ(guessed.edge_count, 2U);
  EXPECT_NEAR(guessed.edges[1].step, 0.06, 1e-6);
  EXPECT_GT(step_sigmas_[1], 2.0 * sure);
  EXPECT_NEAR(step_sigmas_[1], std::sqrt(2.0 * 4e-6), 1e-4) << "that of a cell on either side";
}

TEST_F(StepFeaturesTest, StepAskewIsOneEdgeWhereItCrossesTheJumpLine) {
  stance_.heading = 0.15;
  const core::OneStepTerrain terrain =
      features({.blocks = {{-1.0, 0.40, 0.0}, {0.40, 0.90, 0.12}, {0.90, 3.0, 0.24}}});
  ASSERT_EQ(terrain.edge_count, 2U);
  EXPECT_EQ(terrain.gap_count, 0U);
  const double along = 1.0 / std::cos(stance_.heading);
  EXPECT_EQ(terrain.edges[0].kind, EdgeKind::up);
  EXPECT_NEAR(terrain.edges[0].x, 0.40 * along, kHalfCell);
  EXPECT_NEAR(terrain.edges[0].step, 0.12, 0.002) << "slices near it hold cells of both sides";
  EXPECT_NEAR(terrain.edges[1].x, 0.90 * along, kHalfCell);
}

TEST_F(StepFeaturesTest, GapAskewIsAsWideAsItIsAlongTheJumpLine) {
  stance_.heading = -0.2;
  const core::OneStepTerrain terrain = features({.blocks = {{-1.0, 0.40, 0.0}, {0.60, 3.0, 0.0}}});
  ASSERT_EQ(terrain.gap_count, 1U);
  const double width = terrain.gaps[0].far_x - terrain.gaps[0].near_x;
  EXPECT_NEAR(width, 0.20 / std::cos(stance_.heading), kHalfCell);
}

TEST_F(StepFeaturesTest, EdgeBeforeOneFootOnlyIsWhereThatFootMeetsIt) {
  core::TerrainMap map = test::known_map({.blocks = {{-1.0, 0.70, 0.0}, {0.90, 3.0, 0.0}}});
  for (int iy = map.size_y / 2; iy < map.size_y; ++iy) {  // the left half ends earlier
    for (int ix = 0; ix < map.size_x; ++ix) {
      const double x = map.origin_x + (ix + 0.5) * map.resolution;
      if (x > 0.45 && x < 0.90) map.at(ix, iy).state = core::CellState::occluded;
    }
  }
  const std::vector<Slice> slices = cut_slices(config_, map, stance_);
  DividedLine line{.treads = find_treads(config_, slices), .breaks = {}};
  line.breaks = find_breaks(map, stance_, line.treads);
  core::OneStepTerrain terrain;
  static_cast<void>(list_features(config_, slices, line, terrain));
  ASSERT_EQ(terrain.gap_count, 1U);
  EXPECT_NEAR(terrain.gaps[0].near_x, 0.45, kHalfCell);
  EXPECT_NEAR(terrain.gaps[0].far_x, 0.90, kHalfCell);
}

TEST_F(StepFeaturesTest, SmallUnevennessIsNoStep) {
  const core::OneStepTerrain terrain = features({.blocks = {{-1.0, 0.40, 0.0}, {0.40, 3.0, 0.02}}});
  EXPECT_EQ(terrain.edge_count, 0U);
}

TEST_F(StepFeaturesTest, SlotThatNoFootFitsInIsPartOfTheGap) {
  const core::OneStepTerrain terrain =
      features({.blocks = {{-1.0, 0.40, 0.0}, {0.45, 0.55, -0.1}, {0.60, 3.0, 0.0}}});
  ASSERT_EQ(terrain.gap_count, 1U);
  EXPECT_NEAR(terrain.gaps[0].far_x - terrain.gaps[0].near_x, 0.20, 2.0 * kHalfCell);
}

TEST_F(StepFeaturesTest, FloorOfAPitIsNoTread) {
  const core::OneStepTerrain terrain =
      features({.blocks = {{-1.0, 0.40, 0.0}, {0.40, 0.80, -0.45}, {0.80, 3.0, 0.0}}});
  ASSERT_EQ(terrain.gap_count, 1U);
  EXPECT_NEAR(terrain.gaps[0].far_x, 0.80, kHalfCell);
}

TEST_F(StepFeaturesTest, LowerTreadThatAFootFitsOnIsKept) {
  const core::OneStepTerrain terrain =
      features({.blocks = {{-1.0, 0.40, 0.0}, {0.40, 0.80, -0.05}, {0.80, 3.0, 0.0}}});
  EXPECT_EQ(terrain.gap_count, 0U);
  ASSERT_EQ(terrain.edge_count, 2U);
  EXPECT_EQ(terrain.edges[0].kind, EdgeKind::down);
  EXPECT_EQ(terrain.edges[1].kind, EdgeKind::up);
}

TEST_F(StepFeaturesTest, EndOfTheWorldIsAnEdgeWithoutAGap) {
  const core::OneStepTerrain terrain = features({.blocks = {{-1.0, 0.70, 0.0}}});
  EXPECT_EQ(terrain.gap_count, 0U);
  ASSERT_EQ(terrain.edge_count, 1U);
  EXPECT_EQ(terrain.edges[0].kind, EdgeKind::gap_near);
  EXPECT_NEAR(terrain.edges[0].x, 0.70, kHalfCell);
  EXPECT_TRUE(std::isnan(terrain.edges[0].step)) << "nobody knows what is behind it";
}

TEST_F(StepFeaturesTest, MoreFeaturesThanFitAreCutNotOverrun) {
  test::Course comb;
  for (int i = -3; i < 15; ++i) comb.blocks.push_back({0.1 * i, 0.1 * i + 0.05, 0.0});
  const core::OneStepTerrain terrain = features(comb);
  EXPECT_LE(terrain.edge_count, core::OneStepTerrain::kMaxFeatures);
  EXPECT_LE(terrain.gap_count, core::OneStepTerrain::kMaxFeatures);
  EXPECT_GT(terrain.gap_count, 5U);
}

}  // namespace
}  // namespace hopscotch::perception
