#include "perception/cell_height.hpp"

#include <gtest/gtest.h>

#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

constexpr double kExpected = 12.0;  // points in a covered cell half a metre ahead

class CellHeightTest : public ::testing::Test {
 protected:
  /// Rows of three points over part of the cell, from `from` to `to` [cells off the centre].
  void add_surface(float height, float from, float to, int rows) {
    for (int row = 0; row < rows; ++row) {
      const float x =
          from + (to - from) * (static_cast<float>(row) + 0.5F) / static_cast<float>(rows);
      for (const float y : {-0.33F, 0.0F, 0.33F}) points_.push_back({height, x, y});
    }
  }
  /// An upright face below `top`, three points every 3 mm.
  void add_riser(float top, float x, int rows) {
    for (int row = 0; row < rows; ++row) {
      const float height = top - 0.003F * (static_cast<float>(row) + 0.5F);
      for (const float y : {-0.33F, 0.0F, 0.33F}) points_.push_back({height, x, y});
    }
  }
  CellReading read() { return read_cell(config_, kExpected, points_); }

  MapperConfig config_ = test::perception_config().mapper;
  std::vector<MapPoint> points_;
};

TEST_F(CellHeightTest, CoveredCellHasItsMeanHeight) {
  add_surface(0.10F, -0.5F, 0.5F, 2);
  add_surface(0.104F, -0.5F, 0.5F, 2);
  const CellReading reading = read();
  EXPECT_EQ(reading.kind, CellReadingKind::surface);
  EXPECT_FLOAT_EQ(reading.height, 0.102F);
  EXPECT_FALSE(reading.has_riser);
}

TEST_F(CellHeightTest, TooFewPointsSayNothing) {
  points_.push_back({0.1F, 0.0F, 0.0F});
  EXPECT_EQ(read().kind, CellReadingKind::nothing);
  points_.clear();
  EXPECT_EQ(read().kind, CellReadingKind::nothing);
}

TEST_F(CellHeightTest, TreadAndFloorAreNotAveraged) {
  add_surface(0.20F, -0.5F, 0.4F, 4);
  add_surface(0.0F, 0.4F, 0.5F, 2);
  const CellReading reading = read();
  EXPECT_EQ(reading.kind, CellReadingKind::surface);
  EXPECT_FLOAT_EQ(reading.height, 0.20F);
}

TEST_F(CellHeightTest, FlyingPointsDoNotRaiseTheGround) {
  add_surface(0.0F, -0.5F, 0.5F, 4);
  points_.push_back({0.08F, 0.1F, 0.1F});
  points_.push_back({0.083F, 0.2F, 0.1F});
  const CellReading reading = read();
  EXPECT_EQ(reading.kind, CellReadingKind::surface);
  EXPECT_FLOAT_EQ(reading.height, 0.0F);
}

TEST_F(CellHeightTest, SurfaceThatEndsBeforeTheCentreLeavesTheCellUncovered) {
  add_surface(0.0F, -0.5F, -0.1F, 2);
  EXPECT_EQ(read().kind, CellReadingKind::off_centre);
}

TEST_F(CellHeightTest, RiserDoesNotPullTheTreadsCentreBack) {
  // The tread covers the far 30 % of the cell; the face below it stands at 20 % ahead of the
  // centre.
  add_surface(0.0F, 0.2F, 0.5F, 2);
  add_riser(0.0F, 0.2F, 60);
  const CellReading reading = read();
  EXPECT_EQ(reading.kind, CellReadingKind::off_centre);
  EXPECT_TRUE(reading.has_riser);
}

TEST_F(CellHeightTest, TreadOverMostOfTheCellCountsDespiteItsRiser) {
  add_surface(0.0F, -0.3F, 0.5F, 4);
  add_riser(0.0F, -0.3F, 60);
  const CellReading reading = read();
  EXPECT_EQ(reading.kind, CellReadingKind::surface);
  EXPECT_NEAR(reading.height, 0.0F, 0.003F)
      << "to one row of the riser, which must not pull it down";
}

TEST_F(CellHeightTest, BareRiserIsNoSurface) {
  add_riser(0.0F, 0.0F, 80);
  const CellReading reading = read();
  EXPECT_EQ(reading.kind, CellReadingKind::off_centre);
  EXPECT_TRUE(reading.has_riser);
}

}  // namespace
}  // namespace hopscotch::perception
