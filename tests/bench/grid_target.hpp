#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "core/config_reader.hpp"
#include "model/stand_posture.hpp"
#include "planner/decision_layout.hpp"
#include "planner/ipopt_problem.hpp"
#include "planner/jump_program.hpp"
#include "planner/landing_phase.hpp"
#include "planner/planar_task.hpp"
#include "planner/step_target.hpp"
#include "planner/warm_start.hpp"

namespace hopscotch::planner {

/// A target of the published grid.
struct GridTarget {
  double distance = 0.0;  ///< [m]
  double height = 0.0;    ///< [m]
  StartKind start = StartKind::stand;
};

/// The default robot's planar problems for targets of the grid, and Ipopt's answers to them.
struct GridProblems {
  explicit GridProblems(const std::filesystem::path& config_folder)
      : robot(model::RobotParameters::load(config_folder / "robots" / "hector.yaml")),
        root(core::ConfigReader::from_file(config_folder / "hopscotch.yaml")),
        posture(model::StandPosture::load(root.section("model").section("stand_posture"))),
        model(robot, PlannerConfig::load(root.section("planner"))),
        layout(model.config.steps) {}

  [[nodiscard]] PlanRequest request_of(const GridTarget& target) const {
    const StepRequest step{.distance = target.distance,
                           .height = target.height,
                           .edge = default_edge(target.distance, target.height)};
    return {.start = start_state(target.start, robot, posture).value(),
            .target = step_target(step, robot),
            .final_posture = posture};
  }

  [[nodiscard]] core::Result<PlanarTask> task_of(const GridTarget& target) const {
    return planar_task(model, request_of(target));
  }

  [[nodiscard]] SolveOptions options() const {
    return {model.config.iterations_max, model.config.tolerance};
  }

  [[nodiscard]] SolveOutcome by_ipopt(const PlanarTask& task, const Eigen::VectorXd& start,
                                      const SolveOptions& options) const {
    return solve_with_ipopt(jump_program(model, task, layout), decision_bounds(model, task, layout),
                            decision_sizes(layout), {start}, options);
  }

  model::RobotParameters robot;
  core::ConfigReader root;
  model::StandPosture posture;
  PlanarModel model;
  DecisionLayout layout;
};

}  // namespace hopscotch::planner
