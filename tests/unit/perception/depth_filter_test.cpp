#include "perception/depth_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

/// A body that is nowhere near the camera.
BodyCapsules no_body() {
  BodyCapsules body;
  for (Capsule& capsule : body) {
    capsule = {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 0, -2), 0.01};
  }
  return body;
}

class DepthFilterTest : public ::testing::Test {
 protected:
  core::DepthFrame wall(float depth) const {
    core::DepthFrame frame = test::empty_frame(kWidth, kHeight, 0.0);
    frame.depth.assign(frame.depth.size(), depth);
    return frame;
  }
  float& at(core::DepthFrame& frame, int u, int v) const {
    return frame.depth[static_cast<std::size_t>(v * kWidth + u)];
  }
  float filtered_at(int u, int v) const {
    return filtered_[static_cast<std::size_t>(v * kWidth + u)];
  }

  static constexpr int kWidth = 64;
  static constexpr int kHeight = 48;
  PerceptionConfig config_ = test::perception_config();
  DepthFilter filter_{config_.filter, config_.noise};
  std::vector<float> filtered_;
};

TEST_F(DepthFilterTest, LeavesASmoothSurfaceUntouched) {
  const core::DepthFrame frame = wall(1.0F);
  const FilterCounts counts = filter_.filter(frame, no_body(), filtered_);
  EXPECT_EQ(counts.measured, kWidth * kHeight);
  EXPECT_EQ(counts.kept, kWidth * kHeight);
  EXPECT_EQ(filtered_, frame.depth);
}

TEST_F(DepthFilterTest, RemovesWhatIsTooNearOrTooFar) {
  for (const float depth : {0.1F, 2.9F}) {
    EXPECT_EQ(filter_.filter(wall(depth), no_body(), filtered_).kept, 0);
  }
}

TEST_F(DepthFilterTest, RemovesNumbersThatAreNone) {
  core::DepthFrame frame = wall(1.0F);
  at(frame, 10, 10) = std::numeric_limits<float>::quiet_NaN();
  at(frame, 20, 10) = std::numeric_limits<float>::infinity();
  at(frame, 30, 10) = -1.0F;
  at(frame, 40, 10) = 0.0F;
  const FilterCounts counts = filter_.filter(frame, no_body(), filtered_);
  EXPECT_EQ(counts.measured, kWidth * kHeight - 4);
  for (const int u : {10, 20, 30, 40}) {
    EXPECT_EQ(filtered_at(u, 10), 0.0F) << "holes stay holes, column " << u;
    EXPECT_EQ(filtered_at(u + 1, 10), 1.0F) << "and do not spread, column " << u;
  }
}

TEST_F(DepthFilterTest, RemovesFlyingPixelsBetweenTwoSurfaces) {
  core::DepthFrame frame = wall(1.0F);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 32; u < kWidth; ++u) at(frame, u, v) = 1.5F;
    at(frame, 32, v) = 1.25F;  // neither the one nor the other
  }
  filter_.filter(frame, no_body(), filtered_);
  EXPECT_EQ(filtered_at(32, 20), 0.0F);
  EXPECT_EQ(filtered_at(28, 20), 1.0F);
  EXPECT_EQ(filtered_at(36, 20), 1.5F);
}

TEST_F(DepthFilterTest, KeepsLevelGroundUpToTheLargestRange) {
  const test::Course flat{.blocks = {{-1.0, 9.0, 0.0, 5.0}}};
  const core::DepthFrame frame = test::render(flat, test::standing_at(flat, 0.0, 0.0, 0.0));
  const FilterCounts counts = filter_.filter(frame, no_body(), filtered_);
  int in_range = 0;
  for (const float z : frame.depth) in_range += z >= 0.25F && z <= 2.2F ? 1 : 0;
  EXPECT_GT(counts.kept, 0.98 * in_range);
}

TEST_F(DepthFilterTest, MasksTheRobotsOwnBody) {
  BodyCapsules body = no_body();
  body[0] = {Eigen::Vector3d(0, 0, 0.5), Eigen::Vector3d(0, 0.2, 0.5), 0.03};
  filter_.filter(wall(1.0F), body, filtered_);
  EXPECT_EQ(filtered_at(32, 24), 0.0F);  // the capsule starts at the centre of the image
  EXPECT_EQ(filtered_at(32, 38), 0.0F);  // and goes down 0.2 m / 0.5 m 38.5 px = 15 px
  EXPECT_EQ(filtered_at(32, 10), 1.0F);
  EXPECT_EQ(filtered_at(5, 24), 1.0F);
}

TEST_F(DepthFilterTest, CutsBodyPartsBehindTheCamera) {
  BodyCapsules body = no_body();
  body[0] = {Eigen::Vector3d(0.3, 0, 0.8), Eigen::Vector3d(0.3, 0, -0.5), 0.02};
  const FilterCounts counts = filter_.filter(wall(1.0F), body, filtered_);
  EXPECT_LT(counts.kept, kWidth * kHeight);
  EXPECT_EQ(filtered_at(5, 24), 1.0F);  // left of the centre, the part lies to the right
}

}  // namespace
}  // namespace hopscotch::perception
