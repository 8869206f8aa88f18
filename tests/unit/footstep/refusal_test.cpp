#include "footstep/refusal.hpp"

#include <gtest/gtest.h>

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
    const core::Refusal refusal = explain_place(config_, place(0.4, 0.1, why));
    EXPECT_EQ(refusal.reason, why);
    EXPECT_NE(refusal.sentence.find("40.0 cm"), std::string::npos) << refusal.sentence;
  }
}

}  // namespace
}  // namespace hopscotch::footstep
