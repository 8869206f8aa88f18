#include "footstep/refusal.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/footstep/known_course.hpp"

namespace hopscotch::footstep {
namespace {

using core::Reason;

JudgedFoothold place(double x, double height, Reason why) {
  JudgedFoothold judged;
  judged.foothold.placement.x = x;
  judged.foothold.height = height;
  judged.why = why;
  return judged;
}

class RefusalTest : public ::testing::Test {
 protected:
  FootstepConfig config_ = test::footstep_config();
  core::OneStepTerrain terrain_;
};

TEST_F(RefusalTest, GapIsGivenWithItsWidth) {
  terrain_.gaps[0] = {.near_x = 0.2, .far_x = 0.65, .sigma = 0.01};
  terrain_.gap_count = 1;
  const core::Refusal refusal =
      explain_refusal(config_, terrain_, {place(0.77, 0.0, Reason::out_of_reach)});
  EXPECT_EQ(refusal.reason, Reason::gap_too_wide);
  EXPECT_NE(refusal.sentence.find("45.0 cm"), std::string::npos) << refusal.sentence;
  EXPECT_NE(refusal.sentence.find("77.0 cm"), std::string::npos) << refusal.sentence;
}

TEST_F(RefusalTest, FarPlaceWithoutAGapIsOutOfReach) {
  const core::Refusal refusal =
      explain_refusal(config_, terrain_, {place(0.9, 0.0, Reason::out_of_reach)});
  EXPECT_EQ(refusal.reason, Reason::out_of_reach);
}

TEST_F(RefusalTest, HeightsAreGivenInCentimetres) {
  const core::Refusal up =
      explain_refusal(config_, terrain_, {place(0.4, 0.30, Reason::step_too_high)});
  EXPECT_EQ(up.reason, Reason::step_too_high);
  EXPECT_NE(up.sentence.find("30.0 cm"), std::string::npos) << up.sentence;
  const core::Refusal down =
      explain_refusal(config_, terrain_, {place(0.4, -0.34, Reason::step_too_low)});
  EXPECT_EQ(down.reason, Reason::step_too_low);
  EXPECT_NE(down.sentence.find("34.0 cm"), std::string::npos) << down.sentence;
}

TEST_F(RefusalTest, EndOfAllSupportIsAGap) {
  terrain_.edges[0] = {.x = 0.12, .sigma = 0.006, .kind = core::EdgeKind::gap_near};
  terrain_.edge_count = 1;
  const core::Refusal refusal = explain_refusal(config_, terrain_, {});
  EXPECT_EQ(refusal.reason, Reason::gap_too_wide);
  EXPECT_NE(refusal.sentence.find("12.0 cm"), std::string::npos) << refusal.sentence;
}

TEST_F(RefusalTest, NothingSeenIsUnseen) {
  EXPECT_EQ(explain_refusal(config_, terrain_, {}).reason, Reason::terrain_unseen);
}

TEST_F(RefusalTest, EveryReasonOfAPlaceHasASentence) {
  for (const Reason why : {Reason::terrain_unseen, Reason::step_too_high, Reason::step_too_low,
                           Reason::out_of_reach, Reason::tread_too_short, Reason::no_safe_target}) {
    const core::Refusal refusal =
        explain_place(config_, place(0.7, 0.1, why), {.distance = 0.7, .height = 0.1});
    EXPECT_EQ(refusal.reason, why);
    EXPECT_NE(refusal.sentence.find("70.0 cm"), std::string::npos) << refusal.sentence;
  }
}

struct UnreachedCase {
  Leap leap;
  const char* sentence;
};

class UnreachedPlace : public ::testing::TestWithParam<UnreachedCase> {};

TEST_P(UnreachedPlace, IsRefusedByTheOneRuleItBreaks) {
  FootstepConfig config = test::footstep_config();
  config.reach.height = {-0.3, 0.2};
  config.reach.distance_min = {0.06, 0.06};
  config.reach.distance_max = {0.55, 0.55};
  config.reach.takeoff_edge_max = {0.12, 0.12};
  config.reach.past_edge_min = {0.2, 0.2};
  const Leap& leap = GetParam().leap;
  ASSERT_EQ(reach_verdict(config.reach, leap), Reason::out_of_reach);
  const JudgedFoothold judged = place(leap.distance, leap.height, Reason::out_of_reach);
  EXPECT_EQ(explain_place(config, judged, leap).sentence, GetParam().sentence);
}

constexpr double kNoEdge = std::numeric_limits<double>::infinity();
INSTANTIATE_TEST_SUITE_P(
    Refusal, UnreachedPlace,
    ::testing::Values(
        UnreachedCase{{0.0, 0.0, kNoEdge}, "0.0 cm is too near; the shortest jump is 6.0 cm"},
        UnreachedCase{{0.6, 0.1, kNoEdge},
                      "60.0 cm is too far; a jump to that height reaches 55.0 cm"},
        UnreachedCase{
            {0.5, -0.2, 0.2},
            "a jump down by 20.0 cm starts at most 12.0 cm before the edge, which is 20.0 "
            "cm ahead"},
        UnreachedCase{
            {0.25, -0.2, 0.1},
            "a jump down by 20.0 cm lands at least 20.0 cm beyond the edge, which is 10.0 "
            "cm ahead; 25.0 cm is too near"},
        UnreachedCase{{0.5, -0.2, kNoEdge}, "no edge to jump down from is seen on the way"}));

}  // namespace
}  // namespace hopscotch::footstep
