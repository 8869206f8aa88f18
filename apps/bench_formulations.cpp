#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "apps/bench.hpp"
#include "apps/flight_trial.hpp"
#include "apps/installation.hpp"
#include "apps/stopwatch.hpp"
#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kRepeats = 3;

/// The source's three jumps; the last by the robot of its simulator.
struct ComparedJump {
  const char* name;
  const char* robot;
  double distance;
  double height;
};
constexpr ComparedJump kJumps[] = {{"0.25 m", "hector", 0.25, 0.0},
                                   {"0.40 m", "hector", 0.40, 0.0},
                                   {"0.40 m, 0.40 m up (sim)", "hector-sim", 0.40, 0.40}};

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

const core::JumpKnot* liftoff_of(const core::JumpPlan& plan) {
  const auto* const end = plan.knots.data() + plan.knot_count;
  const auto* const found = std::find_if(plan.knots.data(), end, [](const core::JumpKnot& knot) {
    return knot.phase == core::JumpPhase::flight;
  });
  return found == end ? nullptr : found;
}

void add_flown(const core::JumpPlan& plan, const FlownJump& flown, Json& row) {
  row["outcome"] = jump_outcome_name(flown.jump.outcome);
  row["landing_error_m"] = number(flown.landing_error);
  const core::JumpKnot* const liftoff = liftoff_of(plan);
  row["promised_speed_x_mps"] = liftoff != nullptr ? number(liftoff->v_WG.x()) : Json();
  row["promised_speed_z_mps"] = liftoff != nullptr ? number(liftoff->v_WG.z()) : Json();
  row["flown_speed_x_mps"] = number(flown.jump.takeoff.speed_x);
  row["flown_speed_z_mps"] = number(flown.jump.takeoff.speed_z);
  row["dense_max_violation"] = plan.certificate.dense_max_violation;
}

Json compare(const BenchSetup& setup, const ComparedJump& jump, planner::Formulation formulation) {
  const model::RobotParameters robot = model::RobotParameters::load(robot_file(jump.robot));
  const planner::StepRequest step{.distance = jump.distance,
                                  .height = jump.height,
                                  .edge = planner::default_edge(jump.distance, jump.height)};
  const std::optional<core::RobotState> start =
      planner::start_state(planner::StartKind::stand, robot, setup.config.stand_posture);
  if (!start) throw core::ConfigError("model.stand_posture cannot be taken");
  const planner::PlanRequest request{.start = *start,
                                     .target = planner::step_target(step, robot),
                                     .final_posture = setup.config.stand_posture,
                                     .formulation = formulation};
  planner::JumpPlanner planner(setup.config.planner, robot);
  std::vector<double> solve_ms;
  core::Result<core::JumpPlan> plan = core::Refusal{};
  for (int i = 0; i < kRepeats; ++i) {
    const Stopwatch watch(TimeOf::thread);
    plan = planner.plan(request);
    solve_ms.push_back(watch.milliseconds());
  }
  Json row{{"jump", jump.name},
           {"model", planner::formulation_name(formulation)},
           {"solver", formulation == planner::Formulation::variable ? "chain" : "ipopt"},
           {"solve_ms", Percentiles::of(solve_ms).p50},
           {"iterations", planner.iterations()},
           {"outcome", "no plan"},
           {"landing_error_m", Json()}};
  if (plan) add_flown(*plan, fly({*plan, step, setup.config, robot}), row);
  return row;
}

}  // namespace

nlohmann::ordered_json bench_formulations(const BenchSetup& setup) {
  Json rows = Json::array();
  for (const ComparedJump& jump : kJumps) {
    for (const planner::Formulation formulation :
         {planner::Formulation::variable, planner::Formulation::full,
          planner::Formulation::kinodynamic, planner::Formulation::paper,
          planner::Formulation::single_body}) {
      rows.push_back(compare(setup, jump, formulation));
    }
  }
  return {{"n", rows.size()}, {"compare", rows}};
}

}  // namespace hopscotch::apps
