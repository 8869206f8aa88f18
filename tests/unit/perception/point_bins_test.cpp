#include "perception/point_bins.hpp"

#include <gtest/gtest.h>

#include "perception/map_window.hpp"
#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

constexpr float kSinglePrecision = 2e-6F;  // of coordinates up to 3 m [m]

class PointBinsTest : public ::testing::Test {
 protected:
  void look_at(const test::Course& course, double yaw = 0.0) {
    test::Course turned = course;
    turned.yaw = yaw;
    const core::RobotState state = test::standing_at(turned, 0.0, 0.0, 0.0);
    const core::DepthFrame frame = test::render(turned, state);
    Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
    X_WB.linear() = state.R_WB;
    X_WB.translation() = state.p_WB;
    limits_.ahead = {std::cos(yaw), std::sin(yaw)};
    bins_.fill({frame.intrinsics, frame.depth, X_WB * frame.X_BC}, window_.map, limits_);
  }

  MapWindow window_ = empty_window(test::perception_config().mapper, {0.0, 0.0});
  BinningLimits limits_{.lateral_max = 0.5, .hidden_length = 0.03};
  PointBins bins_;
};

TEST_F(PointBinsTest, PointsOfLevelGroundLieOnIt) {
  look_at({.blocks = {{-1.0, 9.0, 0.05, 5.0}}});
  ASSERT_GT(bins_.size(), 1000U);
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    for (const MapPoint& point : bins_.points(bin)) {
      ASSERT_NEAR(point.height, 0.05F, kSinglePrecision);
      ASSERT_LE(std::abs(point.offset_x), 0.5F + 1e-4F);
      ASSERT_LE(std::abs(point.offset_y), 0.5F + 1e-4F);
    }
  }
  EXPECT_TRUE(bins_.sight_lines().empty());
}

TEST_F(PointBinsTest, EachCellComesOnce) {
  look_at({.blocks = {{-1.0, 9.0, 0.0, 5.0}}});
  std::vector<int> seen(window_.map.cells.size(), 0);
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    ASSERT_EQ(seen[bins_.cell(bin)]++, 0);
    ASSERT_FALSE(bins_.points(bin).empty());
  }
}

TEST_F(PointBinsTest, LeavesOutWhatIsFarToTheSideAtAnyHeading) {
  for (const double yaw : {0.0, 0.7, -2.0}) {
    look_at({.blocks = {{-1.0, 9.0, 0.0, 5.0}}}, yaw);
    ASSERT_GT(bins_.size(), 1000U);
    const core::TerrainMap& map = window_.map;
    for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
      const std::size_t size_x = static_cast<std::size_t>(map.size_x);
      const double x =
          map.origin_x + (static_cast<double>(bins_.cell(bin) % size_x) + 0.5) * map.resolution;
      const double y =
          map.origin_y + (static_cast<double>(bins_.cell(bin) / size_x) + 0.5) * map.resolution;
      ASSERT_LE(std::abs(-std::sin(yaw) * x + std::cos(yaw) * y), 0.5 + map.resolution)
          << "yaw " << yaw;
    }
  }
}

TEST_F(PointBinsTest, JumpOverAGapLeavesSightLines) {
  look_at({.blocks = {{-1.0, 0.5, 0.0, 5.0}, {0.7, 9.0, 0.0, 5.0}}});
  ASSERT_FALSE(bins_.sight_lines().empty());
  for (const SightLine& line : bins_.sight_lines()) {
    EXPECT_LT(line.near.head<2>().norm(), line.far.head<2>().norm());
    EXPECT_LT(line.near_cell, window_.map.cells.size());
  }
}

TEST_F(PointBinsTest, CoarserSteppingKeepsTheSameCellsWithFewerPoints) {
  const test::Course flat{.blocks = {{-1.0, 9.0, 0.0, 5.0}}};
  const auto count = [&] {
    std::size_t points = 0;
    for (std::size_t bin = 0; bin < bins_.size(); ++bin) points += bins_.points(bin).size();
    return points;
  };
  look_at(flat);
  const std::size_t all_cells = bins_.size();
  const std::size_t all_points = count();
  limits_.column_step = 2;
  limits_.near_row_step = 2;
  look_at(flat);
  EXPECT_LT(count(), 0.45 * static_cast<double>(all_points));
  EXPECT_GT(bins_.size(), 0.95 * static_cast<double>(all_cells));
}

}  // namespace
}  // namespace hopscotch::perception
