#include "footstep/terrain_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/footstep/known_course.hpp"

namespace hopscotch::footstep {
namespace {

using core::CellState;
using core::TerrainProfile;

class TerrainProfileTest : public ::testing::Test {
 protected:
  TerrainProfileTest() {
    for (int i = 0; i < TerrainProfile::kSamples; ++i) set(i, CellState::never_seen, kUnbounded);
  }
  void set(int i, CellState state, double upper) {
    const std::size_t k = static_cast<std::size_t>(i);
    seen_.state[k] = state;
    seen_.upper[k] = upper;
    const bool observed = state == CellState::observed;
    seen_.mean[k] = seen_.lower[k] = observed ? upper : core::kNaN;
  }
  void observe(double from, double to, double height) {
    for (int i = TerrainProfile::sample(from); i <= TerrainProfile::sample(to); ++i) {
      set(i, CellState::observed, height);
    }
  }
  double upper(const BoundedProfile& bounded, double x) const {
    return bounded.profile.upper[static_cast<std::size_t>(TerrainProfile::sample(x))];
  }

  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  ProfileConfig config_ = test::footstep_config().profile;
  TerrainProfile seen_;
};

TEST_F(TerrainProfileTest, ObservedGroundIsLeftAlone) {
  observe(-0.3, 1.5, 0.07);
  const BoundedProfile bounded = bound_profile(config_, seen_);
  EXPECT_EQ(bounded.profile.upper, seen_.upper);
  EXPECT_EQ(bounded.profile.mean, seen_.mean);
  EXPECT_TRUE(bounded.is_bounded(-0.3, 1.49));
}

TEST_F(TerrainProfileTest, UnknownBetweenTwoRimsRisesLittleAboveTheHigherOne) {
  observe(-0.3, 0.3, 0.0);
  observe(0.5, 1.5, 0.1);
  const BoundedProfile bounded = bound_profile(config_, seen_);
  EXPECT_DOUBLE_EQ(upper(bounded, 0.4), 0.1 + config_.unknown_margin);
  EXPECT_TRUE(bounded.is_bounded(0.0, 1.0));
}

TEST_F(TerrainProfileTest, RayLowersTheBound) {
  observe(-0.3, 0.3, 0.0);
  observe(0.5, 1.5, 0.1);
  set(TerrainProfile::sample(0.4), CellState::occluded, 0.03);
  EXPECT_DOUBLE_EQ(upper(bound_profile(config_, seen_), 0.4), 0.03);
}

TEST_F(TerrainProfileTest, NothingIsFlownOverThatIsNotEnclosed) {
  observe(-0.3, 0.3, 0.0);
  const BoundedProfile bounded = bound_profile(config_, seen_);
  EXPECT_TRUE(bounded.is_bounded(0.0, 0.29));
  EXPECT_FALSE(bounded.is_bounded(0.0, 0.4));
}

TEST_F(TerrainProfileTest, LongUnknownStretchIsNotFlownOver) {
  observe(-0.3, 0.3, 0.0);
  observe(0.3 + config_.unknown_length_max + 0.1, 1.5, 0.0);
  EXPECT_FALSE(bound_profile(config_, seen_).is_bounded(0.0, 1.4));
}

TEST_F(TerrainProfileTest, GroundBehindTheRobotContinuesLevel) {
  observe(-0.08, 1.5, 0.02);
  const BoundedProfile bounded = bound_profile(config_, seen_);
  EXPECT_DOUBLE_EQ(upper(bounded, -0.25), 0.02);
  EXPECT_TRUE(bounded.is_bounded(-0.3, 0.5));
}

TEST_F(TerrainProfileTest, AllNumbersAreFiniteWhateverWasSeen) {
  const auto all_finite = [](const BoundedProfile& bounded) {
    for (std::size_t i = 0; i < TerrainProfile::kSamples; ++i) {
      if (!std::isfinite(bounded.profile.upper[i])) return false;
      if (!std::isfinite(bounded.profile.mean[i])) return false;
      if (!std::isfinite(bounded.profile.lower[i])) return false;
    }
    return true;
  };
  EXPECT_TRUE(all_finite(bound_profile(config_, seen_))) << "nothing seen at all";
  observe(0.1, 0.3, 0.0);
  EXPECT_TRUE(all_finite(bound_profile(config_, seen_)));
  set(TerrainProfile::sample(1.0), CellState::occluded, 0.2);
  EXPECT_TRUE(all_finite(bound_profile(config_, seen_)));
}

TEST_F(TerrainProfileTest, PlacesBeyondTheProfileAreUnknown) {
  observe(-0.3, 1.5, 0.0);
  EXPECT_FALSE(bound_profile(config_, seen_).is_bounded(0.0, 1.6));
}

TEST_F(TerrainProfileTest, HighestBoundOnTheWay) {
  observe(-0.3, 1.5, 0.0);
  observe(0.30, 0.33, 0.12);
  const BoundedProfile bounded = bound_profile(config_, seen_);
  EXPECT_DOUBLE_EQ(bounded.highest(0.0, 0.2), 0.0);
  EXPECT_DOUBLE_EQ(bounded.highest(0.0, 0.5), 0.12);
}

}  // namespace
}  // namespace hopscotch::footstep
