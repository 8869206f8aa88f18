#include "apps/flight_trial.hpp"

#include <gtest/gtest.h>

#include "tests/unit/apps/planned_trial.hpp"

namespace hopscotch::apps {
namespace {

using testing::planned_trial;

/// The planner promises 2 cm; a turn or a step to the side is not what the MPC was tuned on.
constexpr double kAhead = 0.02;
constexpr double kAside = 0.03;
constexpr double kTurned = 0.08;

TEST(FlightTrial, LandsWhereThePlanSays) {
  const FlownJump flown = fly(planned_trial({.distance = 0.35}));
  EXPECT_EQ(flown.jump.outcome, JumpOutcome::landed) << flown.jump.reason;
  EXPECT_LT(flown.landing_error, kAhead);
  EXPECT_NEAR(flown.jump.flight, 0.26, 0.03);
  EXPECT_GT(flown.jump.landing.pitch_error, 0.001);  // no impact leaves the trunk alone
  EXPECT_LT(flown.jump.landing.pitch_error, 0.2);
}

TEST(FlightTrial, FliesToTheSideAndTurns) {
  const FlownJump flown = fly(planned_trial({.distance = 0.35, .lateral = -0.10, .yaw = -0.2618}));
  EXPECT_EQ(flown.jump.outcome, JumpOutcome::landed) << flown.jump.reason;
  EXPECT_LT(flown.landing_error, kAside);
  EXPECT_NEAR(flown.yaw, -0.2618, kTurned);
}

TEST(FlightTrial, DoesNotLandOnGroundThatIsNotThere) {
  FlightTrial onto_a_wall = planned_trial({.distance = 0.35});
  onto_a_wall.step.height = 0.25;
  onto_a_wall.step.edge = 0.15;
  EXPECT_EQ(fly(onto_a_wall).jump.outcome, JumpOutcome::fell);
}

}  // namespace
}  // namespace hopscotch::apps
