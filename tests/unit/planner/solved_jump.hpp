#pragma once

#include "planner/ipopt_problem.hpp"
#include "planner/jump_program.hpp"
#include "planner/warm_start.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner::testing_support {

/// A planar jump, solved with the shipped tuning.
struct SolvedJump {
  PlanarModel model;
  PlanarTask task;
  SolveOutcome outcome;
  PlanarMotion motion;
};

inline SolvedJump solve_jump(double distance, double height) {
  const PlanarModel model = shipped_model();
  const PlanarTask goal = task(model, distance, height);
  const DecisionLayout layout(model.config.steps);
  const SolveOutcome outcome =
      solve_with_ipopt(jump_program(model, goal, layout), decision_bounds(model, goal, layout),
                       decision_sizes(layout), {kinematic_guess(model, goal, layout)},
                       {model.config.iterations_max, model.config.tolerance});
  return {model, goal, outcome, motion_from_decision(model, goal, layout, outcome.x)};
}

/// Solved once for all tests of the program.
inline const SolvedJump& level_jump() {
  static const SolvedJump jump = solve_jump(0.40, 0.0);
  return jump;
}

}  // namespace hopscotch::planner::testing_support
