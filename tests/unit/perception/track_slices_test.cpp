#include "perception/track_slices.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/perception/flat_map.hpp"

namespace hopscotch::perception {
namespace {

using core::CellState;
using test::set_stretch;
using test::Strip;
using test::unseen_map;

const Slice& slice_at(const std::vector<Slice>& slices, double x) {
  return slices[static_cast<std::size_t>(
      std::lround((x - core::TerrainProfile::kStart) / kSliceStep))];
}

class TrackSlicesTest : public ::testing::Test {
 protected:
  std::vector<Slice> cut() const { return cut_slices(config_, map_, stance_); }

  OneStepConfig config_ = test::perception_config().one_step;
  core::TerrainMap map_ = unseen_map();
  StancePose stance_{
      .p_WS = {0.0, 0.0, 0.1}, .heading = 0.0, .half_stance = 0.098, .track_half_width = 0.04};
};

TEST_F(TrackSlicesTest, HeightsAreRelativeToTheStance) {
  set_stretch(map_, -0.5, 2.0, {.height = 0.15F, .upper = 0.16F, .state = CellState::observed});
  const std::vector<Slice> slices = cut();
  EXPECT_EQ(slice_at(slices, 0.4).kind, SliceKind::level);
  EXPECT_NEAR(slice_at(slices, 0.4).mean, 0.05, 1e-6);
  EXPECT_NEAR(slice_at(slices, 0.4).upper, 0.06, 1e-6);
}

TEST_F(TrackSlicesTest, NothingSeenIsUnboundedAndRaysBoundIt) {
  set_stretch(map_, 0.5, 0.8, {.upper = 0.3F, .state = CellState::occluded});
  const std::vector<Slice> slices = cut();
  EXPECT_EQ(slice_at(slices, 0.3).kind, SliceKind::unseen);
  EXPECT_TRUE(std::isinf(slice_at(slices, 0.3).upper));
  EXPECT_EQ(slice_at(slices, 0.65).kind, SliceKind::hidden);
  EXPECT_NEAR(slice_at(slices, 0.65).upper, 0.2, 1e-6);
  EXPECT_TRUE(std::isnan(slice_at(slices, 0.65).mean));
}

TEST_F(TrackSlicesTest, LooselyBoundedCellDoesNotLiftObservedGround) {
  set_stretch(map_, -0.5, 2.0, {.height = 0.1F, .upper = 0.1F, .state = CellState::observed});
  set_stretch(map_, 0.49, 0.51, {.upper = 0.5F, .state = CellState::occluded}, Strip{0.10, 0.12});
  const Slice slice = slice_at(cut(), 0.5);
  EXPECT_EQ(slice.kind, SliceKind::level);
  EXPECT_NEAR(slice.upper, 0.0, 1e-6);
}

TEST_F(TrackSlicesTest, OneTrackHigherThanTheOtherIsBroken) {
  set_stretch(map_, -0.5, 2.0, {.height = 0.1F, .upper = 0.1F, .state = CellState::observed});
  set_stretch(map_, 0.4, 0.6, {.height = 0.2F, .upper = 0.2F, .state = CellState::observed},
              Strip{0.0, 0.5});  // the left half only
  const Slice slice = slice_at(cut(), 0.5);
  EXPECT_EQ(slice.kind, SliceKind::broken);
  EXPECT_NEAR(slice.lower, 0.0, 1e-6);
  EXPECT_NEAR(slice.upper, 0.1, 1e-6);
}

TEST_F(TrackSlicesTest, WhatLiesBetweenTheTracksDoesNotCount) {
  set_stretch(map_, -0.5, 2.0, {.height = 0.1F, .upper = 0.1F, .state = CellState::observed});
  set_stretch(map_, 0.4, 0.6, {.height = 0.4F, .upper = 0.4F, .state = CellState::observed},
              Strip{-0.04, 0.04});
  EXPECT_EQ(slice_at(cut(), 0.5).kind, SliceKind::level);
}

TEST_F(TrackSlicesTest, StripBelowTheCamerasViewIsBlindNotUnseen) {
  set_stretch(map_, -0.1, 0.085, {.height = 0.1F, .upper = 0.1F, .state = CellState::observed});
  set_stretch(map_, 0.24, 2.0, {.height = 0.11F, .upper = 0.11F, .state = CellState::observed});
  const Slice slice = slice_at(cut(), 0.16);
  EXPECT_EQ(slice.kind, SliceKind::blind);
  EXPECT_NEAR(slice.upper, 0.01, 1e-6) << "the higher one of its ends";
}

TEST_F(TrackSlicesTest, BlindStripMustBeShortAndLevel) {
  const core::TerrainCell here{.height = 0.1F, .upper = 0.1F, .state = CellState::observed};
  set_stretch(map_, -0.1, 0.085, here);
  set_stretch(map_, 0.40, 2.0, here);
  EXPECT_EQ(slice_at(cut(), 0.2).kind, SliceKind::unseen) << "too long";
  set_stretch(map_, 0.24, 2.0, {.height = 0.15F, .upper = 0.15F, .state = CellState::observed});
  EXPECT_EQ(slice_at(cut(), 0.16).kind, SliceKind::unseen) << "a step";
}

TEST_F(TrackSlicesTest, GapThatRaysCrossedIsNoBlindStrip) {
  const core::TerrainCell here{.height = 0.1F, .upper = 0.1F, .state = CellState::observed};
  set_stretch(map_, -0.1, 0.085, here);
  set_stretch(map_, 0.085, 0.24, {.upper = 0.1F, .state = CellState::occluded});
  set_stretch(map_, 0.24, 2.0, here);
  EXPECT_EQ(slice_at(cut(), 0.16).kind, SliceKind::hidden);
}

}  // namespace
}  // namespace hopscotch::perception
