#include "footstep/landing_selector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "footstep/reachability.hpp"
#include "tests/unit/footstep/known_course.hpp"

namespace hopscotch::footstep {
namespace {

using core::Reason;
using test::Course;
using test::KnownCourse;

constexpr double kCell = 0.015;  // [m]

const Course kFlat{.blocks = {{-1.0, 3.0, 0.0}}};

TEST(LandingSelector, LevelGroundGivesTheNominalLeap) {
  const core::TargetChoice choice = KnownCourse(kFlat).choose();
  ASSERT_TRUE(choice.target) << choice.refusal.text();
  EXPECT_NEAR(choice.target->distance, 0.40, 1e-9);
  EXPECT_NEAR(choice.target->height, 0.0, 1e-6);
  EXPECT_GT(choice.target->safe_probability, 0.995);
  EXPECT_EQ(choice.target->source, core::TargetSource::perception);
  EXPECT_GT(choice.ranked_count, 10U);
}

TEST(LandingSelector, SolesKeepTheirStanceAndHeadingInTheWorld) {
  Course course = kFlat;
  course.yaw = 0.6;
  const core::TargetChoice choice = KnownCourse(course, 0.2).choose();
  ASSERT_TRUE(choice.target);
  const Eigen::Vector3d left = choice.target->X_WF[0].translation();
  const Eigen::Vector3d right = choice.target->X_WF[1].translation();
  const Eigen::Vector3d middle = 0.5 * (left + right);
  EXPECT_NEAR(middle.x(), 0.6 * std::cos(0.6), 1e-6);
  EXPECT_NEAR(middle.y(), 0.6 * std::sin(0.6), 1e-6);
  EXPECT_NEAR((left - right).norm(), 0.196, 1e-6);
  EXPECT_GT((left - right).dot(Eigen::Vector3d(-std::sin(0.6), std::cos(0.6), 0.0)), 0.0);
  EXPECT_NEAR(choice.target->X_WF[0].linear()(1, 0), std::sin(0.6), 1e-6);
  EXPECT_NEAR(choice.target->heading, 0.6, 1e-6);
}

TEST(LandingSelector, SolesOnGroundThatSlopesAcrossStandAtDifferentHeights) {
  constexpr double kAcross = 0.1;  // [rad]
  KnownCourse known(kFlat);
  for (int iy = 0; iy < known.map.size_y; ++iy) {
    for (int ix = 0; ix < known.map.size_x; ++ix) {
      const double y = known.map.origin_y + (iy + 0.5) * known.map.resolution;
      known.map.at(ix, iy).height = static_cast<float>(std::tan(kAcross) * y);
    }
  }
  known.look_again();
  const core::TargetChoice choice = known.choose();
  ASSERT_TRUE(choice.target) << choice.refusal.text();
  const Eigen::Vector3d to_left =
      choice.target->X_WF[0].translation() - choice.target->X_WF[1].translation();
  EXPECT_NEAR(std::atan2(to_left.z(), to_left.y()), kAcross, 0.005);
}

TEST(LandingSelector, SteppingStoneIsHitNearItsCentre) {
  const Course stones{
      .blocks = {
          {-1.0, 0.125, 0.0}, {0.325, 0.575, 0.0}, {0.775, 1.025, 0.0}, {1.225, 1.475, 0.0}}};
  const core::TargetChoice choice = KnownCourse(stones).choose();
  ASSERT_TRUE(choice.target) << choice.refusal.text();
  EXPECT_NEAR(choice.target->distance, 0.45, kCell);
  EXPECT_GE(choice.target->margin, test::footstep_config().foothold.margin_min);
}

TEST(LandingSelector, RisingBoxIsClimbedWithHeelsClearOfItsEdge) {
  for (const double height : {0.05, 0.10, 0.15, 0.20}) {
    const Course boxes{.blocks = {{-1.0, 0.22, 0.0}, {0.22, 0.72, height}, {0.72, 3.0, height}}};
    const core::TargetChoice choice = KnownCourse(boxes).choose();
    ASSERT_TRUE(choice.target) << height << ": " << choice.refusal.text();
    EXPECT_NEAR(choice.target->height, height, 1e-6);
    EXPECT_GT(choice.target->distance - 0.075, 0.22 + 0.03);
  }
}

TEST(LandingSelector, UnevenTreadsAreTakenWithTheirHeights) {
  const Course uneven{
      .blocks = {{-1.0, 0.2, 0.0}, {0.2, 0.55, 0.05}, {0.55, 0.9, -0.05}, {0.9, 1.3, 0.0}}};
  const core::TargetChoice choice = KnownCourse(uneven).choose();
  ASSERT_TRUE(choice.target) << choice.refusal.text();
  EXPECT_NEAR(choice.target->height, 0.05, 1e-6);
}

TEST(LandingSelector, JumpDownStartsOnlyFromTheEdge) {
  const Course block{.blocks = {{-1.0, 0.60, 0.25}, {0.60, 3.0, 0.0}}};
  const core::TargetChoice first = KnownCourse(block, 0.0).choose();
  ASSERT_TRUE(first.target) << first.refusal.text();
  EXPECT_NEAR(first.target->height, 0.0, 1e-6) << "first hop to the edge, on the block";
  const double x = first.target->distance;
  EXPECT_LT(0.60 - x, reach_at(test::footstep_config().reach, -0.25).takeoff_edge_max);
  const core::TargetChoice down = KnownCourse(block, x).choose();
  ASSERT_TRUE(down.target) << down.refusal.text();
  EXPECT_NEAR(down.target->height, -0.25, 1e-6);
}

TEST(LandingSelector, WideGapAheadDrawsTheLandingToTheEdge) {
  const Course course{.blocks = {{-1.0, 0.62, 0.0}, {0.88, 3.0, 0.0}}};  // a gap of 26 cm
  const core::TargetChoice choice = KnownCourse(course).choose();
  ASSERT_TRUE(choice.target) << choice.refusal.text();
  const double next_landing = 0.88 + 0.075 + 0.035 - choice.target->distance;
  EXPECT_LT(next_landing, 0.55) << "the far side must be within the next jump's reach";
}

TEST(LandingSelector, StopsRightBehindTheGoal) {
  const LandingTask near_goal{.goal_x = 0.20};
  const core::TargetChoice choice = KnownCourse(kFlat).choose(near_goal);
  ASSERT_TRUE(choice.target);
  const double heels = choice.target->distance - 0.075;
  EXPECT_GT(heels, 0.20);
  EXPECT_LT(heels, 0.20 + 0.03);
}

TEST(LandingSelector, GoalIsMeasuredAlongItsOwnAxis) {
  Course course = kFlat;
  course.yaw = 1.2;
  const LandingTask near_goal{.goal_x = 0.20, .goal_heading = 1.2};
  const core::TargetChoice choice = KnownCourse(course).choose(near_goal);
  ASSERT_TRUE(choice.target);
  EXPECT_NEAR(choice.target->distance - 0.075, 0.22, 0.01);
}

TEST(LandingSelector, ChoiceIsTheSameAtAnyHeading) {
  Course stones{.blocks = {{-1.0, 0.125, 0.0}, {0.325, 0.605, 0.03}, {0.775, 1.055, 0.0}}};
  const core::TargetChoice straight = KnownCourse(stones).choose();
  ASSERT_TRUE(straight.target);
  for (const double yaw : {0.5, 1.57, -2.2}) {
    stones.yaw = yaw;
    const core::TargetChoice turned = KnownCourse(stones).choose();
    ASSERT_TRUE(turned.target) << yaw << ": " << turned.refusal.text();
    EXPECT_NEAR(turned.target->distance, straight.target->distance, kCell) << yaw;
    EXPECT_NEAR(turned.target->height, straight.target->height, 1e-6) << yaw;
  }
}

TEST(LandingSelector, ProfileOfTheTargetIsFiniteEverywhere) {
  const Course stones{.blocks = {{-1.0, 0.125, 0.0}, {0.325, 0.605, 0.03}}};
  const core::TargetChoice choice = KnownCourse(stones).choose();
  ASSERT_TRUE(choice.target);
  for (std::size_t i = 0; i < core::TerrainProfile::kSamples; ++i) {
    EXPECT_TRUE(std::isfinite(choice.target->profile.upper[i])) << i;
    EXPECT_TRUE(std::isfinite(choice.target->profile.mean[i])) << i;
    EXPECT_TRUE(std::isfinite(choice.target->profile.lower[i])) << i;
  }
}

/// One cell that sticks out does not turn the plane under the soles, and the planner would put no
/// foot into it: another place is chosen, and this one is named.
TEST(LandingSelector, NoSoleComesDownOnWhatSticksOut) {
  KnownCourse course(kFlat);
  const auto cell_at = [&](double x, double y) -> core::TerrainCell& {
    return course.map.at(static_cast<int>((x - course.map.origin_x) / course.map.resolution),
                         static_cast<int>((y - course.map.origin_y) / course.map.resolution));
  };
  core::TerrainCell& sticking_out = cell_at(0.40, 0.098);
  sticking_out.height += 0.06F;
  sticking_out.upper += 0.06F;
  course.look_again();
  const core::TargetChoice choice = course.choose();
  ASSERT_TRUE(choice.target) << choice.refusal.text();
  EXPECT_GT(std::abs(choice.target->distance - 0.40), 0.06);
  LandingTask task;
  task.target = core::TargetOverride{.distance = 0.40};
  const core::TargetChoice wanted = course.choose(task);
  ASSERT_FALSE(wanted.target);
  EXPECT_EQ(wanted.refusal.reason, Reason::no_safe_target);
  EXPECT_NE(wanted.refusal.sentence.find("no flat ground"), std::string::npos)
      << wanted.refusal.sentence;
}

struct RefusedCourse {
  const char* name;
  Course course;
  Reason reason;
};

class LandingSelectorRefuses : public ::testing::TestWithParam<RefusedCourse> {};

TEST_P(LandingSelectorRefuses, WithTheReasonAndASentence) {
  const core::TargetChoice choice = KnownCourse(GetParam().course).choose();
  EXPECT_FALSE(choice.target);
  EXPECT_EQ(choice.refusal.reason, GetParam().reason) << choice.refusal.text();
  EXPECT_FALSE(choice.refusal.sentence.empty());
  EXPECT_EQ(choice.ranked_count, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    Courses, LandingSelectorRefuses,
    ::testing::Values(
        RefusedCourse{
            "WideGap", {.blocks = {{-1.0, 0.12, 0.0}, {0.62, 3.0, 0.0}}}, Reason::gap_too_wide},
        RefusedCourse{"EndOfTheWorld", {.blocks = {{-1.0, 0.12, 0.0}}}, Reason::gap_too_wide},
        RefusedCourse{
            "HighWall", {.blocks = {{-1.0, 0.16, 0.0}, {0.16, 3.0, 0.35}}}, Reason::step_too_high},
        RefusedCourse{
            "DeepDrop", {.blocks = {{-1.0, 0.12, 0.0}, {0.12, 3.0, -0.32}}}, Reason::step_too_low},
        RefusedCourse{"NarrowStones",
                      {.blocks = {{-1.0, 0.12, 0.0}, {0.25, 0.43, 0.0}, {0.56, 0.74, 0.0}}},
                      Reason::tread_too_short}),
    [](const auto& tested) { return tested.param.name; });

TEST(LandingSelector, UnseenGroundIsRefused) {
  KnownCourse known(kFlat);
  known.map = test::unseen_map();
  known.terrain = perception::one_step_terrain(
      test::perception_config().one_step, known.map,
      perception::stance_pose(test::perception_config().one_step, test::hector(), known.state));
  const core::TargetChoice choice = known.choose();
  EXPECT_FALSE(choice.target);
  EXPECT_EQ(choice.refusal.reason, Reason::terrain_unseen);
}

TEST(LandingSelector, EmptyMapAndLostStateAreRefused) {
  KnownCourse known(kFlat);
  known.state.p_WB.setConstant(core::kNaN);
  EXPECT_EQ(known.choose().refusal.reason, Reason::terrain_unseen);
  KnownCourse empty(kFlat);
  empty.map = {};
  EXPECT_EQ(empty.choose().refusal.reason, Reason::terrain_unseen);
}

TEST(LandingSelector, ShortHopIntoADeadEndIsRefused) {
  const Course end{.blocks = {{-1.0, 0.26, 0.0}}};  // 15 cm of room ahead, then nothing
  const core::TargetChoice choice = KnownCourse(end).choose();
  EXPECT_FALSE(choice.target);
  EXPECT_GT(choice.ranked_count, 0U) << "there are places, but they lead nowhere";
  EXPECT_EQ(choice.refusal.reason, Reason::gap_too_wide);
}

TEST(LandingSelector, OperatorsTargetIsJudgedByTheSameRules) {
  const Course stones{.blocks = {{-1.0, 0.125, 0.0}, {0.325, 0.605, 0.03}}};
  const KnownCourse known(stones);
  LandingTask task;
  task.target = core::TargetOverride{.distance = 0.46};
  const core::TargetChoice good = known.choose(task);
  ASSERT_TRUE(good.target) << good.refusal.text();
  EXPECT_DOUBLE_EQ(good.target->distance, 0.46);
  EXPECT_NEAR(good.target->height, 0.03, 1e-6);
  EXPECT_EQ(good.target->source, core::TargetSource::operator_override);

  task.target = core::TargetOverride{.distance = 0.25};  // over the gap
  EXPECT_EQ(known.choose(task).refusal.reason, Reason::no_safe_target);
  task.target = core::TargetOverride{.distance = 0.46, .height = 0.2};
  EXPECT_EQ(known.choose(task).refusal.text(),
            "no_safe_target: the ground there is 3.0 cm high, not 20.0 cm");
  task.target = core::TargetOverride{.distance = 0.46, .height = 0.035};
  EXPECT_TRUE(known.choose(task).target);
}

TEST(LandingSelector, OperatorsTargetOutOfReachOrMalformedIsRefused) {
  const KnownCourse known(kFlat);
  LandingTask task;
  task.target = core::TargetOverride{.distance = 0.9};
  EXPECT_EQ(known.choose(task).refusal.text(),
            "out_of_reach: 90.0 cm is farther than any jump; the longest is 55.0 cm");
  task.target = core::TargetOverride{.distance = core::kNaN};
  EXPECT_EQ(known.choose(task).refusal.reason, Reason::target_malformed);
  task.target = core::TargetOverride{.distance = 0.4, .lateral = 0.5};
  EXPECT_EQ(known.choose(task).refusal.text(),
            "out_of_reach: a jump leads at most 10.0 cm to a side and turns at most 0.26 rad");
  task.target =
      core::TargetOverride{.distance = 0.4, .yaw = std::numeric_limits<double>::infinity()};
  EXPECT_EQ(known.choose(task).refusal.reason, Reason::target_malformed);
}

TEST(LandingSelector, OperatorsTurnTurnsTheSoles) {
  LandingTask task;
  task.target = core::TargetOverride{.distance = 0.4, .lateral = 0.03, .yaw = 0.1};
  const core::TargetChoice choice = KnownCourse(kFlat).choose(task);
  ASSERT_TRUE(choice.target) << choice.refusal.text();
  const Eigen::Vector3d middle =
      0.5 * (choice.target->X_WF[0].translation() + choice.target->X_WF[1].translation());
  EXPECT_NEAR(middle.y(), 0.03, 1e-6);
  EXPECT_NEAR(choice.target->X_WF[0].linear()(1, 0), std::sin(0.1), 1e-6);
}

}  // namespace
}  // namespace hopscotch::footstep
