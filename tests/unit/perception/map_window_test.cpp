#include "perception/map_window.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

using core::CellState;

core::TerrainCell& cell_at(MapWindow& window, double x, double y) {
  core::TerrainMap& map = window.map;
  return map.at(static_cast<int>(std::floor((x - map.origin_x) / map.resolution)),
                static_cast<int>(std::floor((y - map.origin_y) / map.resolution)));
}

class MapWindowTest : public ::testing::Test {
 protected:
  MapperConfig config_ = test::perception_config().mapper;
  MapWindow window_ = empty_window(config_, {0.8, 0.0});
};

TEST_F(MapWindowTest, StartsUnseenAroundItsCentre) {
  EXPECT_NEAR(window_.map.origin_x + 0.5 * config_.window, 0.8, config_.resolution);
  EXPECT_NEAR(window_.map.origin_y + 0.5 * config_.window, 0.0, config_.resolution);
  for (const core::TerrainCell& cell : window_.map.cells) {
    ASSERT_EQ(cell.state, CellState::never_seen);
    ASSERT_TRUE(std::isinf(cell.upper));
  }
}

TEST_F(MapWindowTest, CellsKeepTheirPlaceInTheWorldWhenItMoves) {
  cell_at(window_, 1.0, 0.2) = {.height = 0.3F, .state = CellState::observed};
  for (const Eigen::Vector2d& centre :
       {Eigen::Vector2d(1.7, 0.4), Eigen::Vector2d(0.1, -0.8), Eigen::Vector2d(0.8, 0.0)}) {
    follow(config_, centre, window_);
    EXPECT_NEAR(window_.map.origin_x + 0.5 * config_.window, centre.x(), config_.resolution);
    EXPECT_FLOAT_EQ(cell_at(window_, 1.0, 0.2).height, 0.3F);
    int observed = 0;
    for (const core::TerrainCell& cell : window_.map.cells) {
      observed += cell.state == CellState::observed ? 1 : 0;
    }
    EXPECT_EQ(observed, 1);
  }
}

TEST_F(MapWindowTest, ForgetsWhatLeavesIt) {
  cell_at(window_, 1.0, 0.2).state = CellState::observed;
  follow(config_, {9.0, 0.0}, window_);
  follow(config_, {0.8, 0.0}, window_);
  EXPECT_EQ(cell_at(window_, 1.0, 0.2).state, CellState::never_seen);
}

TEST_F(MapWindowTest, StaysForSmallMotions) {
  const double origin = window_.map.origin_x;
  follow(config_, {0.8 + 0.9 * config_.reanchor_distance, 0.0}, window_);
  EXPECT_EQ(window_.map.origin_x, origin);
}

}  // namespace
}  // namespace hopscotch::perception
