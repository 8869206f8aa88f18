#include <vector>

#include "apps/bench.hpp"
#include "apps/run_result.hpp"
#include "apps/stopwatch.hpp"
#include "core/config_reader.hpp"
#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps {

nlohmann::ordered_json percentile_group(std::vector<double> samples, double scale) {
  for (double& sample : samples) sample *= scale;
  const Percentiles percentiles = Percentiles::of(std::move(samples));
  return {{"p50", percentiles.p50}, {"p99", percentiles.p99}, {"max", percentiles.max}};
}

namespace {

/// Distances and heights inside of what `footstep.reach` lets the robot choose [m].
std::vector<planner::StepRequest> reachable_grid() {
  std::vector<planner::StepRequest> grid;
  const auto add_row = [&grid](double height, double from, double to) {
    for (double distance = from; distance <= to + 1e-9; distance += 0.03) {
      grid.push_back({.distance = distance,
                      .height = height,
                      .edge = planner::default_edge(distance, height)});
    }
  };
  add_row(0.0, 0.20, 0.53);
  add_row(0.05, 0.30, 0.48);
  add_row(0.10, 0.30, 0.45);
  add_row(0.15, 0.30, 0.42);
  add_row(0.20, 0.30, 0.42);
  add_row(-0.05, 0.30, 0.48);
  add_row(-0.15, 0.33, 0.42);
  add_row(-0.25, 0.36, 0.42);
  return grid;
}

struct PlannerSamples {
  std::vector<double> solve_ms;
  std::vector<double> iteration_ms;
  int solved = 0;
};

void plan_once(planner::JumpPlanner& planner, const planner::PlanRequest& request,
               PlannerSamples& samples) {
  const Stopwatch watch(TimeOf::thread);
  const core::Result<core::JumpPlan> plan = planner.plan(request);
  const double elapsed_ms = watch.milliseconds();
  samples.solve_ms.push_back(elapsed_ms);
  if (!plan) return;
  ++samples.solved;
  if (plan->iterations > 0) samples.iteration_ms.push_back(elapsed_ms / plan->iterations);
}

}  // namespace

nlohmann::ordered_json bench_planner(const BenchSetup& setup) {
  const model::StandPosture& posture = setup.config.stand_posture;
  const std::optional<model::StandPose> pose = model::stand_pose(setup.robot, posture);
  if (!pose) throw core::ConfigError("model.stand_posture cannot be taken");
  planner::JumpPlanner planner(setup.config.planner, setup.robot);
  PlannerSamples cold;
  PlannerSamples warm;
  const std::vector<planner::StepRequest> grid = reachable_grid();
  for (const planner::StepRequest& step : grid) {
    planner::PlanRequest request{.start = planner::standing_state(*pose),
                                 .target = planner::step_target(step, setup.robot),
                                 .final_posture = posture};
    plan_once(planner, request, cold);
    request.guess = planner::StartGuess::previous;
    plan_once(planner, request, warm);
  }
  const double count = static_cast<double>(grid.size());
  return {{"n", grid.size()},
          {"solver", "ipopt"},
          {"cold_ms", percentile_group(cold.solve_ms, 1.0)},
          {"warm_ms", percentile_group(warm.solve_ms, 1.0)},
          {"iteration_ms", percentile_group(cold.iteration_ms, 1.0)},
          {"success", cold.solved / count},
          {"targets", grid.size()}};
}

}  // namespace hopscotch::apps
