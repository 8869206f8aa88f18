#include "apps/flight_trial.hpp"

#include <gtest/gtest.h>

#include "apps/installation.hpp"
#include "planner/jump_planner.hpp"

namespace hopscotch::apps {
namespace {

FlightTrial trial(planner::StepRequest step) {
  step.edge = planner::default_edge(step.distance, step.height);
  const ProgramConfig config = ProgramConfig::load(config_directory() / "hopscotch.yaml");
  const model::RobotParameters robot = model::RobotParameters::load(robot_file("hector"));
  planner::JumpPlanner planner(config.planner, robot);
  const auto plan = planner.plan(
      {.start = planner::standing_state(*model::stand_pose(robot, config.stand_posture)),
       .target = planner::step_target(step, robot),
       .final_posture = config.stand_posture});
  EXPECT_TRUE(plan) << plan.error().text();
  return {*plan, step, config, robot};
}

/// The planner promises 2 cm; a turn or a step to the side is not what the MPC was tuned on.
constexpr double kAhead = 0.02;
constexpr double kAside = 0.03;
constexpr double kTurned = 0.08;

TEST(FlightTrial, LandsWhereThePlanSays) {
  const FlownJump flown = fly(trial({.distance = 0.35}));
  EXPECT_EQ(flown.jump.outcome, JumpOutcome::landed) << flown.jump.reason;
  EXPECT_LT(flown.landing_error, kAhead);
  EXPECT_NEAR(flown.jump.flight, 0.26, 0.03);
  EXPECT_GT(flown.jump.landing.pitch_error, 0.001);  // no impact leaves the trunk alone
  EXPECT_LT(flown.jump.landing.pitch_error, 0.2);
}

TEST(FlightTrial, FliesToTheSideAndTurns) {
  const FlownJump flown = fly(trial({.distance = 0.35, .lateral = -0.10, .yaw = -0.2618}));
  EXPECT_EQ(flown.jump.outcome, JumpOutcome::landed) << flown.jump.reason;
  EXPECT_LT(flown.landing_error, kAside);
  EXPECT_NEAR(flown.yaw, -0.2618, kTurned);
}

TEST(FlightTrial, DoesNotLandOnGroundThatIsNotThere) {
  FlightTrial onto_a_wall = trial({.distance = 0.35});
  onto_a_wall.step.height = 0.25;
  onto_a_wall.step.edge = 0.15;
  EXPECT_EQ(fly(onto_a_wall).jump.outcome, JumpOutcome::fell);
}

}  // namespace
}  // namespace hopscotch::apps
