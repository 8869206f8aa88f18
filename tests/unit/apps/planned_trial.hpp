#pragma once

#include <gtest/gtest.h>

#include "apps/flight_trial.hpp"
#include "apps/installation.hpp"
#include "apps/program_config.hpp"
#include "model/robot_parameters.hpp"
#include "model/stand_posture.hpp"
#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps::testing {

/// A jump from standing, planned with the shipped tuning, ready to be flown.
inline FlightTrial planned_trial(planner::StepRequest step) {
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

}  // namespace hopscotch::apps::testing
