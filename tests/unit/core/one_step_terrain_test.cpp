#include "core/one_step_terrain.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace hopscotch::core {
namespace {

TEST(TerrainProfile, EverySampleFindsItselfByItsPlace) {
  for (int i = 0; i < TerrainProfile::kSamples; ++i) {
    EXPECT_EQ(TerrainProfile::sample(TerrainProfile::x(i)), i);
  }
}

TEST(TerrainProfile, PlaceBetweenSamplesTakesTheNearest) {
  const double off = 0.4 * TerrainProfile::kStep;
  EXPECT_EQ(TerrainProfile::sample(TerrainProfile::x(7) + off), 7);
  EXPECT_EQ(TerrainProfile::sample(TerrainProfile::x(7) - off), 7);
}

TEST(TerrainProfile, PlacesBeyondTheEndsTakeTheLastSample) {
  constexpr int kLast = TerrainProfile::kSamples - 1;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(TerrainProfile::sample(-5.0), 0);
  EXPECT_EQ(TerrainProfile::sample(5.0), kLast);
  EXPECT_EQ(TerrainProfile::sample(-1e300), 0);
  EXPECT_EQ(TerrainProfile::sample(1e300), kLast);
  EXPECT_EQ(TerrainProfile::sample(kInfinity), kLast);
}

TEST(TerrainProfile, NoNumberTakesTheFirstSample) {
  EXPECT_EQ(TerrainProfile::sample(kNaN), 0);
}

TEST(TerrainProfile, CoversTheReachOfOneJump) {
  EXPECT_LE(TerrainProfile::x(0), -0.25);
  EXPECT_GE(TerrainProfile::x(TerrainProfile::kSamples - 1), 1.4);
}

TEST(TerrainProfile, StartsUnseen) {
  const TerrainProfile profile;
  for (const CellState state : profile.state) EXPECT_EQ(state, CellState::never_seen);
}

}  // namespace
}  // namespace hopscotch::core
