#include "perception/depth_noise.hpp"

#include <gtest/gtest.h>

namespace hopscotch::perception {
namespace {

constexpr DepthNoiseConfig kNoise{
    .base = 0.001, .quadratic = 0.0036, .floor = 0.002, .tilt = 0.002};

TEST(DepthNoise, GrowsWithTheSquareOfDepth) {
  EXPECT_DOUBLE_EQ(depth_sigma(kNoise, 0.0), 0.001);
  EXPECT_DOUBLE_EQ(depth_sigma(kNoise, 1.0), 0.0046);
  EXPECT_DOUBLE_EQ(depth_sigma(kNoise, 2.0), 0.0154);
}

TEST(DepthNoise, GroundSeenSteeplyIsAsUncertainAsItsDepth) {
  const ViewOfCell below{.depth = 0.6, .horizontal = 0.0, .rise = -0.6};
  const double sigma = depth_sigma(kNoise, 0.6);
  EXPECT_DOUBLE_EQ(height_variance(kNoise, below), sigma * sigma + kNoise.floor * kNoise.floor);
}

TEST(DepthNoise, GroundSeenAtAGrazingAngleTakesLittleOfTheDepthError) {
  const ViewOfCell far{.depth = 1.8, .horizontal = 1.8, .rise = -0.3};
  const double ray_share = height_variance(kNoise, far) - shared_variance(kNoise, far);
  const double sigma = depth_sigma(kNoise, 1.8);
  EXPECT_DOUBLE_EQ(ray_share, sigma * sigma / 36.0);
}

TEST(DepthNoise, TiltErrorGrowsWithDistanceAndIsShared) {
  const ViewOfCell near{.depth = 0.7, .horizontal = 0.3, .rise = -0.6};
  const ViewOfCell far{.depth = 1.6, .horizontal = 1.5, .rise = -0.6};
  EXPECT_GT(shared_variance(kNoise, far), shared_variance(kNoise, near));
  EXPECT_GT(shared_variance(kNoise, near), kNoise.floor * kNoise.floor);
}

}  // namespace
}  // namespace hopscotch::perception
