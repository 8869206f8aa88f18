#include "footstep/foothold_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/unit/footstep/known_course.hpp"

namespace hopscotch::footstep {
namespace {

using core::CellState;
using core::Reason;
using test::Course;
using test::KnownCourse;

constexpr double kGrid = 0.0075 + 0.005;  // half a cell and one step of the search [m]

class FootholdScoreTest : public ::testing::Test {
 protected:
  Foothold score(const KnownCourse& known, const Placement& placement) const {
    return score_foothold(config_, known.stance(), placement);
  }
  FootholdConfig config_ = test::footstep_config().foothold;
};

TEST_F(FootholdScoreTest, MiddleOfAStoneIsSafeWithItsMargins) {
  const KnownCourse known(Course{.blocks = {{-1.0, 0.15, 0.0}, {0.325, 0.605, 0.05}}});
  const Foothold foothold = score(known, {.x = 0.465});
  EXPECT_EQ(foothold.why, Reason::none);
  EXPECT_NEAR(foothold.height, 0.05, 1e-6);
  EXPECT_NEAR(foothold.toe_margin, 0.065, kGrid);
  EXPECT_NEAR(foothold.heel_margin, 0.065, kGrid);
  EXPECT_GT(foothold.safe_probability, 0.999);
}

TEST_F(FootholdScoreTest, MarginsAreNeverLongerThanTheGridAllows) {
  const double limit = 0.0075 + 1e-9;  // a cell counts when its centre bears
  for (double start = 0.300; start < 0.330; start += 0.002) {
    const KnownCourse known(Course{.blocks = {{-1.0, 0.15, 0.0}, {start, start + 0.28, 0.0}}});
    const Foothold foothold = score(known, {.x = start + 0.14});
    EXPECT_LE(foothold.toe_margin, 0.065 + limit) << start;
    EXPECT_LE(foothold.heel_margin, 0.065 + limit) << start;
  }
}

TEST_F(FootholdScoreTest, ToesTooNearAnEdgeAreRefused) {
  const KnownCourse known(Course{.blocks = {{-1.0, 0.15, 0.0}, {0.3, 0.8, 0.0}}});
  const Foothold foothold = score(known, {.x = 0.71});
  EXPECT_TRUE(foothold.supported);
  EXPECT_EQ(foothold.why, Reason::no_safe_target);
  EXPECT_LT(foothold.toe_margin, config_.margin_min);
}

TEST_F(FootholdScoreTest, ShortTreadIsNamedAsSuch) {
  const KnownCourse known(Course{.blocks = {{-1.0, 0.15, 0.0}, {0.36, 0.54, 0.0}}});
  EXPECT_EQ(score(known, {.x = 0.45}).why, Reason::tread_too_short);
}

TEST_F(FootholdScoreTest, UnseenAndHiddenGroundNeverBears) {
  KnownCourse known(Course{.blocks = {{-1.0, 3.0, 0.0}}});
  test::set_stretch(known.map, 0.42, 0.44, {.upper = 0.0F, .state = CellState::occluded});
  EXPECT_EQ(score(known, {.x = 0.4}).why, Reason::no_safe_target);
  test::set_stretch(known.map, 0.42, 0.44, {});
  EXPECT_EQ(score(known, {.x = 0.4}).why, Reason::terrain_unseen);
  EXPECT_EQ(score(known, {.x = 50.0}).why, Reason::terrain_unseen) << "outside the map";
}

TEST_F(FootholdScoreTest, PoorlyKnownHeightIsUnseen) {
  KnownCourse known(Course{.blocks = {{-1.0, 3.0, 0.0}}});
  for (core::TerrainCell& cell : known.map.cells) cell.variance = 4e-4F;  // 2 cm
  EXPECT_EQ(score(known, {.x = 0.4}).why, Reason::terrain_unseen);
}

TEST_F(FootholdScoreTest, OneFootOverTheSideIsNotSupported) {
  const KnownCourse known(
      Course{.blocks = {{-1.0, 0.2, 0.0}, {0.3, 0.9, 0.0, 0.09}}});  // half as wide as the stance
  EXPECT_FALSE(score(known, {.x = 0.6}).supported);
}

TEST_F(FootholdScoreTest, FeetAcrossAStepAreNotSupported) {
  const KnownCourse known(Course{.blocks = {{-1.0, 0.4, 0.0}, {0.4, 3.0, 0.05}}});
  EXPECT_FALSE(score(known, {.x = 0.4}).supported);
}

TEST_F(FootholdScoreTest, LowStepUnderTheFeetIsNotTakenForASlope) {
  for (const double step : {0.02, -0.02, 0.014}) {
    const KnownCourse known(Course{.blocks = {{-1.0, 0.45, 0.0}, {0.45, 3.0, step}}});
    for (const double x : {0.38, 0.40, 0.45, 0.50, 0.53}) {
      EXPECT_NE(score(known, {.x = x}).why, Reason::none) << "step " << step << " at " << x;
    }
    EXPECT_EQ(score(known, {.x = 0.33}).why, Reason::none) << step;
    EXPECT_EQ(score(known, {.x = 0.58}).why, Reason::none) << step;
  }
}

TEST_F(FootholdScoreTest, NoiseOfSingleCellsIsNoStep) {
  KnownCourse known(Course{.blocks = {{-1.0, 3.0, 0.0}}});
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0.0F, 0.003F);
  for (core::TerrainCell& cell : known.map.cells) cell.height += noise(random);
  int refused = 0;
  for (double x = 0.2; x < 1.0; x += 0.01) {
    refused += score(known, {.x = x}).why == Reason::none ? 0 : 1;
  }
  EXPECT_LE(refused, 2) << "of 80 places on level ground";
}

TEST_F(FootholdScoreTest, SlopeIsBearableUpToItsLimit) {
  for (const double slope : {0.5 * config_.slope_max, 1.3 * config_.slope_max}) {
    KnownCourse known(Course{.blocks = {{-1.0, 3.0, 0.0}}});
    for (int iy = 0; iy < known.map.size_y; ++iy) {
      for (int ix = 0; ix < known.map.size_x; ++ix) {
        const double x = known.map.origin_x + (ix + 0.5) * known.map.resolution;
        known.map.at(ix, iy).height = static_cast<float>(std::tan(slope) * x);
      }
    }
    const Foothold foothold = score(known, {.x = 0.4});
    EXPECT_EQ(foothold.why == Reason::none, slope < config_.slope_max) << slope;
    if (foothold.why == Reason::none) {
      EXPECT_NEAR(foothold.height, 0.4 * std::tan(slope), 0.002);
    }
  }
}

TEST_F(FootholdScoreTest, KneesNeedRoomBelowAHigherBlockBehind) {
  const Course down{.blocks = {{-1.0, 0.2, 0.25}, {0.2, 3.0, 0.0}}};
  const KnownCourse known(down);
  EXPECT_EQ(score(known, {.x = 0.2 + 0.075 + 0.10}).why, Reason::no_safe_target);
  EXPECT_EQ(score(known, {.x = 0.2 + 0.26}).why, Reason::none);
}

TEST_F(FootholdScoreTest, LowStepBehindDoesNotDisturbTheKnees) {
  const KnownCourse known(Course{.blocks = {{-1.0, 0.2, 0.05}, {0.2, 3.0, 0.0}}});
  EXPECT_EQ(score(known, {.x = 0.2 + 0.075 + 0.06}).why, Reason::none);
}

TEST_F(FootholdScoreTest, IsTheSameAtAnyHeading) {
  Course course{.blocks = {{-1.0, 0.15, 0.0}, {0.325, 0.645, 0.05}}};
  const Foothold straight = score(KnownCourse(course), {.x = 0.485});
  for (const double yaw : {0.4, 1.3, -2.5}) {
    course.yaw = yaw;
    const Foothold turned = score(KnownCourse(course), {.x = 0.485});
    EXPECT_EQ(turned.why, straight.why);
    EXPECT_NEAR(turned.height, straight.height, 1e-6);
    EXPECT_NEAR(turned.toe_margin, straight.toe_margin, 0.015) << yaw;
    EXPECT_NEAR(turned.heel_margin, straight.heel_margin, 0.015) << yaw;
  }
}

TEST(SafeProbability, IsTheNormalDistributionBetweenTheMargins) {
  EXPECT_NEAR(safe_probability(0.01, 0.01, 0.01), std::erf(1.0 / std::numbers::sqrt2), 1e-12);
  EXPECT_NEAR(safe_probability(0.0, 1.0, 0.01), 0.5, 1e-12);
  EXPECT_GT(safe_probability(0.04, 0.04, 0.01), 0.9999);
  EXPECT_EQ(safe_probability(-1.0, -1.0, 0.01), 0.0);
}

}  // namespace
}  // namespace hopscotch::footstep
