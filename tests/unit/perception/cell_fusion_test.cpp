#include "perception/cell_fusion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

using core::CellState;

constexpr HeightMeasurement kGround{.height = 0.0F, .variance = 9e-6F, .shared_variance = 4e-6F};
constexpr HeightMeasurement kBox{.height = 0.1F, .variance = 9e-6F, .shared_variance = 4e-6F};

class CellFusionTest : public ::testing::Test {
 protected:
  void fuse(const HeightMeasurement& measurement, int frames) {
    for (int i = 0; i < frames; ++i) fuse_height(config_, measurement, cell_, memory_);
  }

  MapperConfig config_ = test::perception_config().mapper;
  core::TerrainCell cell_{.upper = std::numeric_limits<float>::infinity()};
  CellMemory memory_;
  int frame_ = 0;
};

TEST_F(CellFusionTest, OneFrameAloneDoesNotMakeGround) {
  fuse(kGround, config_.confirm_frames - 1);
  EXPECT_EQ(cell_.state, CellState::never_seen);
  fuse(kGround, 1);
  EXPECT_EQ(cell_.state, CellState::observed);
}

TEST_F(CellFusionTest, MoreFramesReduceVarianceDownToWhatTheyShare) {
  fuse(kGround, config_.confirm_frames);
  const float first = cell_.variance;
  fuse(kGround, 1);
  EXPECT_LT(cell_.variance, first);
  fuse(kGround, 100);
  EXPECT_GE(cell_.variance, kGround.shared_variance);
  EXPECT_LE(cell_.variance, 1.1F * kGround.shared_variance);
  EXPECT_FLOAT_EQ(cell_.upper, 2.0F * std::sqrt(cell_.variance));
}

TEST_F(CellFusionTest, FusedHeightIsTheVarianceWeightedMean) {
  fuse(kGround, config_.confirm_frames);
  const float before = cell_.variance;
  const HeightMeasurement higher{.height = 0.004F, .variance = 9e-6F, .shared_variance = 1e-9F};
  fuse(higher, 1);
  constexpr float kShared = 1e-3F;  // relative: what both share does not average out
  EXPECT_NEAR(cell_.height, 0.004F * before / (before + 9e-6F), kShared * 0.004F);
  EXPECT_NEAR(cell_.variance, before * 9e-6F / (before + 9e-6F), kShared * before);
}

TEST_F(CellFusionTest, ContradictionDoesNotMoveTheCellUntilItPersists) {
  fuse(kGround, 10);
  fuse(kBox, config_.replace_frames - 1);
  EXPECT_FLOAT_EQ(cell_.height, 0.0F);
  fuse(kGround, 1);
  fuse(kBox, config_.replace_frames - 1);
  EXPECT_FLOAT_EQ(cell_.height, 0.0F) << "agreement in between starts the count again";
  fuse(kBox, 1);
  EXPECT_FLOAT_EQ(cell_.height, 0.1F);
  EXPECT_FLOAT_EQ(cell_.variance, kBox.variance);
}

TEST_F(CellFusionTest, RaysOverAHiddenCellLowerItsBound) {
  fuse_sight(config_, 0.3F, 0, cell_, memory_);
  EXPECT_EQ(cell_.state, CellState::occluded);
  EXPECT_FLOAT_EQ(cell_.upper, 0.3F);
  fuse_sight(config_, 0.1F, 0, cell_, memory_);
  fuse_sight(config_, 0.2F, 1, cell_, memory_);
  EXPECT_FLOAT_EQ(cell_.upper, 0.1F);
}

TEST_F(CellFusionTest, RaysBelowAnObservedHeightClearItAfterSomeFrames) {
  fuse(kBox, 5);
  for (int ray = 0; ray < 50; ++ray) fuse_sight(config_, 0.0F, 7, cell_, memory_);
  EXPECT_EQ(cell_.state, CellState::observed) << "all rays of a frame are one piece of evidence";
  for (int frame = 8; frame < 8 + config_.replace_frames; ++frame) {
    fuse_sight(config_, 0.0F, frame, cell_, memory_);
  }
  EXPECT_EQ(cell_.state, CellState::occluded);
  EXPECT_FLOAT_EQ(cell_.upper, 0.0F);
}

TEST_F(CellFusionTest, RaysJustAboveAnEdgeDoNotClearIt) {
  fuse(kBox, 5);
  for (int frame = 0; frame < 50; ++frame) fuse_sight(config_, 0.095F, frame, cell_, memory_);
  EXPECT_EQ(cell_.state, CellState::observed);
}

TEST_F(CellFusionTest, FramesVoteWhetherAnEdgeCellBears) {
  for (int i = 0; i < 20; ++i) {  // two of three frames see less than half of it covered
    fuse_edge(config_, 0.1F, frame_++, cell_, memory_);
    fuse_edge(config_, 0.1F, frame_++, cell_, memory_);
    fuse(kBox, 1);
  }
  EXPECT_EQ(cell_.state, CellState::occluded);
  EXPECT_FLOAT_EQ(cell_.upper, 0.1F);
  fuse(kBox, 10);
  EXPECT_EQ(cell_.state, CellState::observed);
  for (int i = 0; i < 6; ++i) fuse_edge(config_, 0.1F, frame_++, cell_, memory_);
  EXPECT_EQ(cell_.state, CellState::occluded);
}

TEST_F(CellFusionTest, GhostAboveAnEdgeIsClearedByTheSurfaceBelowIt) {
  fuse(kBox, 6);  // flying pixels that happened to agree
  for (int i = 0; i < config_.replace_frames; ++i) {
    fuse_edge(config_, 0.0F, frame_++, cell_, memory_);
  }
  EXPECT_EQ(cell_.state, CellState::occluded);
  EXPECT_FLOAT_EQ(cell_.upper, 0.0F);
}

TEST_F(CellFusionTest, SupportByContactHoldsAtOnce) {
  set_support(0.05F, 0.003F, cell_, memory_);
  EXPECT_EQ(cell_.state, CellState::observed);
  EXPECT_FLOAT_EQ(cell_.height, 0.05F);
  EXPECT_FLOAT_EQ(cell_.variance, 9e-6F);
}

}  // namespace
}  // namespace hopscotch::perception
