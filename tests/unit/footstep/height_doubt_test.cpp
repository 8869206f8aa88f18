#include "footstep/height_doubt.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/footstep/known_course.hpp"

namespace hopscotch::footstep {
namespace {

using core::CellState;
using core::TerrainProfile;

const DoubtConfig kConfig{.tolerance = 0.01, .gain = 2.0, .max = 0.05, .keep = 0.5};

TEST(HeightDoubt, LandingsAsExpectedLeaveNone) {
  HeightDoubt doubt(kConfig);
  doubt.landed(0.009);
  doubt.landed(-0.009);
  doubt.landed(core::kNaN);
  EXPECT_DOUBLE_EQ(doubt.height(), 0.0);
}

TEST(HeightDoubt, SurprisesOfEitherSignRaiseItAndTimeLowersIt) {
  HeightDoubt doubt(kConfig);
  doubt.landed(-0.02);
  EXPECT_DOUBLE_EQ(doubt.height(), 0.02);
  doubt.landed(0.30);
  EXPECT_DOUBLE_EQ(doubt.height(), kConfig.max);
  doubt.landed(0.0);
  EXPECT_DOUBLE_EQ(doubt.height(), 0.025);
}

std::size_t at(double x) {
  return static_cast<std::size_t>(TerrainProfile::sample(x));
}

/// Two treads, `here` to x = 0.2 m and `there` beyond.
TerrainProfile two_treads(double here, double there) {
  TerrainProfile profile;
  for (int i = 0; i < TerrainProfile::kSamples; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    profile.state[k] = CellState::observed;
    profile.mean[k] = profile.lower[k] = profile.upper[k] =
        TerrainProfile::x(i) <= 0.2 ? here : there;
  }
  return profile;
}

TEST(PutUnderfoot, OnlyTheTreadStoodOnIsMovedToTheSoles) {
  TerrainProfile profile = two_treads(0.03, 0.08);
  put_underfoot(profile);
  EXPECT_DOUBLE_EQ(profile.mean[at(-0.2)], 0.0);
  EXPECT_DOUBLE_EQ(profile.upper[at(0.15)], 0.0);
  EXPECT_DOUBLE_EQ(profile.upper[at(0.3)], 0.08);
}

TEST(PutUnderfoot, TheBoundAtTheFootOfARiserStays) {
  TerrainProfile profile = two_treads(0.03, 0.08);
  profile.upper[at(0.195)] = 0.08;  // seen through the neighbouring slice
  put_underfoot(profile);
  EXPECT_DOUBLE_EQ(profile.upper[at(0.195)], 0.08);
  EXPECT_DOUBLE_EQ(profile.mean[at(0.195)], 0.0);
}

TEST(PutUnderfoot, UnseenGroundStaysAsItIs) {
  TerrainProfile profile = two_treads(0.03, 0.08);
  profile.state[at(0.0)] = CellState::occluded;
  put_underfoot(profile);
  EXPECT_DOUBLE_EQ(profile.mean[at(0.1)], 0.03);
}

TEST(TakeOver, LeavesWhatComesBefore) {
  TerrainProfile profile = two_treads(0.0, 0.08);
  take_over(two_treads(0.03, 0.05), 0.15, profile);
  EXPECT_DOUBLE_EQ(profile.upper[at(0.1)], 0.0);
  EXPECT_DOUBLE_EQ(profile.upper[at(0.18)], 0.03);
  EXPECT_DOUBLE_EQ(profile.mean[at(0.3)], 0.05);
}

/// The soles stand 45 mm above (or below) all the ground that the map shows.
class WrongUnderfoot : public testing::TestWithParam<float> {};

TEST_P(WrongUnderfoot, TheTargetLiesOnTheGroundOfItsProfile) {
  test::KnownCourse course({.blocks = {{-1.0, 3.0, 0.0}}});
  for (core::TerrainCell& cell : course.map.cells) {
    cell.height += GetParam();
    cell.upper += GetParam();
  }
  course.look_again();
  const core::TargetChoice choice = course.choose();
  ASSERT_TRUE(choice.target);
  const auto& profile = choice.target->profile;
  EXPECT_NEAR(choice.target->height, static_cast<double>(GetParam()), 1e-6);
  for (const double x : {-0.06, 0.0, 0.06}) {
    EXPECT_NEAR(profile.upper[at(choice.target->distance + x)], choice.target->height, 5e-3);
    EXPECT_NEAR(profile.upper[at(x)], 0.0, 5e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(HighAndLow, WrongUnderfoot, testing::Values(-0.045F, 0.045F));

TEST(HeightDoubt, TheSelectorRaisesWhatIsFlownOverAndLandsInTheMiddle) {
  const test::KnownCourse course(
      {.blocks = {{-1.0, 0.20, 0.0}, {0.25, 0.60, 0.0}, {0.65, 3.0, 0.0}}});
  const core::TargetChoice sure = course.choose();
  const core::TargetChoice unsure = course.choose({.height_doubt = 0.04});
  ASSERT_TRUE(sure.target && unsure.target);
  EXPECT_DOUBLE_EQ(sure.target->distance, 0.40);
  EXPECT_NEAR(unsure.target->distance, 0.425, 0.01);  // the second block's middle
  const auto raised = [&](double x) {
    return unsure.target->profile.upper[at(x)] - sure.target->profile.upper[at(x)];
  };
  const double target = unsure.target->distance;
  EXPECT_DOUBLE_EQ(raised(0.0), 0.0);
  EXPECT_NEAR(raised(0.27), 0.04, 1e-12);
  EXPECT_DOUBLE_EQ(raised(target - 0.075), 0.0);
  EXPECT_DOUBLE_EQ(raised(target), 0.0);
}

}  // namespace
}  // namespace hopscotch::footstep
