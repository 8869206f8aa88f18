#include "apps/black_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include "apps/map_view.hpp"
#include "msgs/run_log.hpp"

namespace hopscotch::apps {
namespace {

core::RobotState state_at(double seconds) {
  core::RobotState state;
  state.stamp = core::Stamp::from_seconds(seconds);
  return state;
}

TEST(BlackBox, KeepsTheLastSecondsOnly) {
  BlackBox box;
  msgs::EventMaker maker(5);
  for (int i = 0; i <= 300; ++i) {
    const core::RobotState state = state_at(0.1 * i);
    box.remember(maker.make(state.stamp, state));
  }
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "black_box.lcm";
  box.write(file, maker.make({}, msgs::Scene{}));
  std::vector<double> times;
  int scenes = 0;
  msgs::RunLogHandlers handlers;
  handlers.scene = [&](core::Stamp now, const msgs::Tagged<msgs::Scene>&) {
    ++scenes;
    EXPECT_TRUE(times.empty()) << "it stands first";
    EXPECT_NEAR(now.seconds(), 10.0, 1e-6) << "a player does not wait";
  };
  handlers.state = [&](core::Stamp now, const msgs::Tagged<core::RobotState>& message) {
    times.push_back(now.seconds());
    EXPECT_EQ(message.tag.run_id, 5U);
  };
  msgs::read_run_log(file, handlers);
  std::filesystem::remove(file);
  EXPECT_EQ(scenes, 1);
  ASSERT_EQ(times.size(), 201U);
  EXPECT_NEAR(times.front(), 10.0, 1e-6);
  EXPECT_NEAR(times.back(), 30.0, 1e-6);
}

TEST(BlackBox, IsBoundedInBytes) {
  BlackBox box;
  for (int i = 0; i < 100; ++i) {
    box.remember({.now = {}, .channel = msgs::kStateChannel, .bytes = msgs::Bytes(1U << 20U)});
  }
  EXPECT_LE(box.bytes(), BlackBox::kMostBytes);
  EXPECT_EQ(box.size(), 64U);
  box.remember(
      {.now = {}, .channel = msgs::kStateChannel, .bytes = msgs::Bytes(BlackBox::kMostBytes + 1)});
  EXPECT_EQ(box.size(), 0U) << "an event that fits nowhere takes the place of none";
}

TEST(MapView, ShowsTheSquareAroundAPlace) {
  core::TerrainMap map;
  map.origin_x = -1.0;
  map.origin_y = -2.0;
  map.resolution = 0.02;
  map.size_x = 200;
  map.size_y = 50;
  map.cells.resize(200U * 50U);
  map.at(100, 10) = {
      .height = 0.1234F, .variance = 0.0F, .upper = 0.13F, .state = core::CellState::observed};
  map.at(101, 10) = {.height = std::numeric_limits<float>::quiet_NaN(),
                     .state = core::CellState::observed};

  const msgs::MapView view = map_view(map, 1.01, -1.79);  // the middle of cell (100, 10)
  EXPECT_EQ(view.size_x, msgs::MapView::kMaxSide);
  // The map has 50 rows, and the view of 96 around row 10 begins before it.
  EXPECT_EQ(view.size_y, 50) << "the map is narrower than the view";
  const int ix = static_cast<int>(std::lround((1.0 - view.origin_x) / view.resolution));
  const int iy = static_cast<int>(std::lround((-1.8 - view.origin_y) / view.resolution));
  const auto at = static_cast<std::size_t>(iy * view.size_x + ix);
  EXPECT_EQ(view.height_mm.at(at), 123);
  EXPECT_EQ(view.state.at(at), core::CellState::observed);
  EXPECT_EQ(view.height_mm.at(at + 1), 0);

  EXPECT_EQ(map_view(map, 100.0, 0.0).size_x, 0);
  EXPECT_EQ(map_view(map, core::kNaN, 0.0).size_x, 0);
}

}  // namespace
}  // namespace hopscotch::apps
