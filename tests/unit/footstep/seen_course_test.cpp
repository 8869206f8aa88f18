#include <gtest/gtest.h>

#include <random>

#include "tests/unit/footstep/known_course.hpp"

/// From noisy depth images to targets, jump after jump; the robot lands where it was told, give or
/// take what a good controller misses by.
namespace hopscotch::footstep {
namespace {

using test::Course;

/// Standard deviation of the landing place [m].
constexpr double kLandingScatter = 0.007;
constexpr int kJumpsMax = 12;
/// The judge of landings: a toe or heel farther beyond an edge has missed [m].
constexpr double kOverEdge = 0.005;

struct SeenCourse {
  const char* name;
  Course course;
  double goal_x;
};

/// Both tips of the soles are on the same top.
bool stands_safely(const Course& course, double x) {
  const double top = test::top_at(course, x, 0.0);
  return test::top_at(course, x + 0.075 - kOverEdge, 0.0) == top &&
         test::top_at(course, x - 0.075 + kOverEdge, 0.0) == top;
}

/// Jumps along the course until the goal; every jump is seen, chosen and landed.
void cross(const Course& course, double goal_x, std::uint32_t seed) {
  const LandingSelector selector(test::footstep_config(), test::hector());
  const LandingTask task{.goal_x = goal_x, .goal_heading = course.yaw};
  perception::TerrainMapper mapper(test::perception_config(), test::hector());
  std::mt19937 random(seed);
  std::normal_distribution<double> scatter(0.0, kLandingScatter);
  double x = 0.0;
  int jumps = 0;
  for (; jumps < kJumpsMax && x - 0.075 <= goal_x; ++jumps) {
    const core::RobotState state =
        test::standing_at(course, x, test::top_at(course, x, 0.0), 1.0 * jumps);
    if (jumps == 0) mapper.anchor_support(state);
    test::look(course, state, 6, seed + 10U * static_cast<std::uint32_t>(jumps), mapper);
    const core::OneStepTerrain terrain = test::preview(mapper, state);
    const core::TargetChoice choice = selector.choose({mapper.map(), terrain}, state, task);
    ASSERT_TRUE(choice.target) << "at " << x << ": " << choice.refusal.text();
    x += choice.target->distance + scatter(random);
    ASSERT_TRUE(stands_safely(course, x)) << "landed at " << x;
  }
  EXPECT_LT(jumps, kJumpsMax);
}

class SeenCourseTest : public ::testing::TestWithParam<SeenCourse> {};

TEST_P(SeenCourseTest, IsCrossedToTheGoalWithoutAMissedStep) {
  cross(GetParam().course, GetParam().goal_x, 100U);
}

TEST_P(SeenCourseTest, IsCrossedLikewiseWhenItLiesAcrossTheGrid) {
  Course course = GetParam().course;
  course.yaw = 0.3;
  cross(course, GetParam().goal_x, 200U);
}

INSTANTIATE_TEST_SUITE_P(
    Courses, SeenCourseTest,
    ::testing::Values(
        SeenCourse{"FlatLeaps", {.blocks = {{-1.0, 6.0, 0.0}}}, 1.9},
        SeenCourse{"Stones",
                   {.blocks = {{-1.0, 0.125, 0.0},
                               {0.325, 0.575, 0.0},
                               {0.775, 1.025, 0.0},
                               {1.225, 1.475, 0.0},
                               {1.675, 3.0, 0.0}}},
                   1.7},
        SeenCourse{"RisingBoxes",
                   {.blocks = {{-1.0, 0.175, 0.0},
                               {0.275, 0.625, 0.05},
                               {0.725, 1.075, 0.10},
                               {1.175, 1.525, 0.15},
                               {1.625, 3.5, 0.20}}},
                   1.65},
        SeenCourse{"OneHighBox", {.blocks = {{-1.0, 0.56, 0.0}, {0.56, 2.0, 0.20}}}, 0.8},
        SeenCourse{"UnevenTreads",
                   {.blocks = {{-1.0, 0.2, 0.0},
                               {0.2, 0.6, 0.05},
                               {0.6, 1.0, 0.0},
                               {1.0, 1.4, -0.02},
                               {1.4, 3.0, 0.0}}},
                   1.5},
        SeenCourse{"JumpDownFromTheEdge", {.blocks = {{-1.0, 0.1, 0.25}, {0.1, 4.0, 0.0}}}, 0.8},
        SeenCourse{
            "JumpDownAfterApproach", {.blocks = {{-1.0, 0.75, 0.25}, {0.75, 4.0, 0.0}}}, 1.2}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace hopscotch::footstep
