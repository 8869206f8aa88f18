#include "planner/smooth_terrain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hopscotch::planner {
namespace {

constexpr SolePlace kStart{-0.075, 0.075, 0.0};
constexpr SolePlace kTarget{0.325, 0.475, 0.1};
constexpr double kEdge = 0.28;

core::TerrainProfile step_profile() {
  core::TerrainProfile profile;
  for (int i = 0; i < core::TerrainProfile::kSamples; ++i) {
    profile.upper[static_cast<std::size_t>(i)] = core::TerrainProfile::x(i) < kEdge ? 0.0 : 0.1;
  }
  return profile;
}

SmoothTerrain step() {
  return *SmoothTerrain::from_profile(step_profile(), kStart, kTarget);
}

TEST(SmoothTerrain, HasContinuousDerivativesThatMatchDifferences) {
  const SmoothTerrain terrain = step();
  constexpr double kStep = 1e-6;
  for (double x = -0.35; x < 1.6; x += 0.0037) {
    const TerrainPoint here = terrain.at(x);
    const double slope =
        (terrain.at(x + kStep).height - terrain.at(x - kStep).height) / (2 * kStep);
    const double curvature =
        (terrain.at(x + kStep).slope - terrain.at(x - kStep).slope) / (2 * kStep);
    EXPECT_NEAR(here.slope, slope, 1e-6) << x;
    EXPECT_NEAR(here.curvature, curvature, 2e-3) << x;  // third derivative jumps by 3e4 at a knot
  }
}

TEST(SmoothTerrain, StaysBelowItsBound) {
  const SmoothTerrain terrain = step();
  for (double from = -0.4; from < 1.7; from += 0.013) {
    for (const double length : {0.0, 0.004, 0.031, 0.2}) {
      const double bound = terrain.height_bound(from, from + length);
      for (double x = from; x <= from + length; x += 0.001) {
        EXPECT_LE(terrain.at(x).height, bound + 1e-12) << x;
      }
    }
  }
  EXPECT_NEAR(terrain.height_bound(kStart.rear, kStart.front), 0.0, 1e-12);
}

TEST(SmoothTerrain, IsFlatUnderTheSoles) {
  const SmoothTerrain terrain = step();
  for (double x = kStart.rear; x <= kStart.front; x += 0.005) {
    EXPECT_NEAR(terrain.at(x).height, 0.0, 1e-12);
  }
  for (double x = kTarget.rear; x <= kTarget.front; x += 0.005) {
    EXPECT_NEAR(terrain.at(x).height, 0.1, 1e-12);
  }
}

TEST(SmoothTerrain, RisesBeforeTheEdgeOfAStep) {
  const SmoothTerrain terrain = step();
  for (double x = kEdge; x < kTarget.rear; x += 0.001) {
    EXPECT_GT(terrain.at(x).height, 0.1 * 5.0 / 6.0);  // a spline misses at most a sixth
  }
  EXPECT_NEAR(terrain.at(kEdge - 0.06).height, 0.0, 1e-12);
}

TEST(SmoothTerrain, ANoisySampleUnderASoleDoesNotLiftIt) {
  core::TerrainProfile profile = step_profile();
  profile.upper[static_cast<std::size_t>(core::TerrainProfile::sample(0.4))] = 0.115;
  const SmoothTerrain terrain = *SmoothTerrain::from_profile(profile, kStart, kTarget);
  EXPECT_NEAR(terrain.at(0.4).height, 0.1, 1e-12);
}

TEST(SmoothTerrain, UnknownGroundOnTheWayIsRefusedAndNamed) {
  for (const double unknown : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    core::TerrainProfile profile = step_profile();
    profile.upper[static_cast<std::size_t>(core::TerrainProfile::sample(0.15))] = unknown;
    const core::Result<SmoothTerrain> terrain =
        SmoothTerrain::from_profile(profile, kStart, kTarget);
    ASSERT_FALSE(terrain);
    EXPECT_EQ(terrain.error().reason, core::Reason::target_malformed);
    EXPECT_NE(terrain.error().sentence.find("0.150"), std::string::npos);
  }
}

TEST(SmoothTerrain, UnknownGroundBeyondTheTargetDoesNotMatter) {
  core::TerrainProfile profile = step_profile();
  profile.upper.back() = std::numeric_limits<double>::infinity();
  const core::Result<SmoothTerrain> terrain = SmoothTerrain::from_profile(profile, kStart, kTarget);
  ASSERT_TRUE(terrain);
  EXPECT_TRUE(std::isfinite(terrain->at(1.5).height));
}

TEST(SmoothTerrain, CarriesDerivativesThroughTheChainRule) {
  const SmoothTerrain terrain = step();
  using T = SecondOrder<1>;
  const T x = T::variable(0.27, 0);
  const T height = terrain.height(x * 1.0);
  const TerrainPoint point = terrain.at(0.27);
  EXPECT_NEAR(height.gradient[0], point.slope, 1e-12);
  EXPECT_NEAR(height.hessian[0], point.curvature, 1e-9);
}

}  // namespace
}  // namespace hopscotch::planner
