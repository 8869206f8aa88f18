#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

#include "apps/bench.hpp"
#include "apps/bench_targets.hpp"
#include "apps/run_result.hpp"
#include "apps/shipped_jumps.hpp"
#include "apps/stopwatch.hpp"
#include "model/knot_state.hpp"
#include "planner/chain_solver.hpp"
#include "planner/ipopt_problem.hpp"
#include "planner/jump_planner.hpp"
#include "planner/jump_program.hpp"
#include "planner/planar_task.hpp"
#include "planner/replanner.hpp"
#include "planner/warm_start.hpp"

namespace hopscotch::apps {

nlohmann::ordered_json percentile_group(std::vector<double> samples, double scale) {
  for (double& sample : samples) sample *= scale;
  const Percentiles percentiles = Percentiles::of(std::move(samples));
  return {{"p50", percentiles.p50}, {"p99", percentiles.p99}, {"max", percentiles.max}};
}

namespace {

/// Ipopt takes twenty times as long: it solves every fifth target.
constexpr std::size_t kIpoptEvery = 5;
/// A warm start comes from the plan to the same place moved by so much [m].
constexpr double kMoved = 0.02;

struct PlannerSamples {
  std::vector<double> plan_ms;
  std::vector<double> iterations;         ///< Of all rungs.
  std::vector<double> dense_violation;    ///< Of the plans that were certified.
  std::map<std::string_view, int> rungs;  ///< Of the same.
  int planned = 0;

  core::Result<core::JumpPlan> plan(planner::JumpPlanner& planner,
                                    const planner::PlanRequest& request) {
    const Stopwatch watch(TimeOf::thread);
    core::Result<core::JumpPlan> result = planner.plan(request);
    plan_ms.push_back(watch.milliseconds());
    iterations.push_back(planner.iterations());
    if (!result) return result;
    ++planned;
    ++rungs[planner::plan_rung_name(planner.rung())];
    dense_violation.push_back(result->certificate.dense_max_violation);
    return result;
  }
};

/// Plans the rests of a jump from knots of its takeoff and landing, as if pushed there.
struct ReplanSamples {
  /// Steps of the phase done, and how much faster than planned the trunk turns then [rad/s].
  struct Push {
    core::JumpPhase phase;
    int steps_done;
    double rate;
  };
  static constexpr std::array kPushes{
      Push{core::JumpPhase::takeoff, 5, 0.1}, Push{core::JumpPhase::takeoff, 12, -0.1},
      Push{core::JumpPhase::takeoff, 18, 0.1}, Push{core::JumpPhase::landing, 2, -0.1},
      Push{core::JumpPhase::landing, 7, 0.1}};

  planner::StepCounts steps;
  planner::Replanner replanner;
  std::vector<double> replan_ms;
  std::vector<double> iterations;
  int planned = 0;

  explicit ReplanSamples(const BenchSetup& setup)
      : steps(setup.config.planner.steps), replanner(setup.config.planner, setup.robot) {}

  void replan(const planner::PlanRequest& request, const core::JumpPlan& plan,
              const planner::KnownJump& solution) {
    const auto whole = std::make_shared<const planner::KnownJump>(solution);
    for (const auto& [phase, of_phase, rate] : kPushes) {
      const int before = phase == core::JumpPhase::landing ? steps.takeoff + steps.flight : 0;
      const int steps_done = before + of_phase;
      planner::RestRequest rest{
          .id = request.id,
          .whole = whole,
          .steps_done = steps_done,
          .state = model::state_of(plan.knots[static_cast<std::size_t>(steps_done)]),
          .target = request.target,
          .final_posture = request.final_posture};
      rest.state.w_WB.y() += rate;
      const Stopwatch watch(TimeOf::thread);
      const bool found = static_cast<bool>(replanner.replan(rest));
      replan_ms.push_back(watch.milliseconds());
      iterations.push_back(replanner.iterations());
      planned += found ? 1 : 0;
    }
  }
};

/// Ipopt's first solve from the closed-form guess, without correction between the knots and without
/// certificate: less than what a plan takes.
struct IpoptSamples {
  planner::PlanarModel model;
  planner::DecisionLayout layout{model.config.steps};
  std::vector<double> solve_ms;

  explicit IpoptSamples(const BenchSetup& setup) : model(setup.robot, setup.config.planner) {}

  void solve(const planner::PlanRequest& request) {
    const core::Result<planner::PlanarTask> task = planner::planar_task(model, request);
    if (!task) return;
    const Stopwatch watch(TimeOf::thread);
    (void)planner::solve_with_ipopt(
        planner::jump_program(model, *task, layout), planner::decision_bounds(model, *task, layout),
        planner::decision_sizes(layout), {planner::kinematic_guess(model, *task, layout)},
        {model.config.iterations_max, model.config.tolerance});
    solve_ms.push_back(watch.milliseconds());
  }
};

/// What an iteration of the chain solver is made of, each piece timed alone at the solution.
struct IterationSamples {
  planner::PlanarModel model;
  planner::DecisionLayout layout{model.config.steps};
  planner::ChainSolver solver{layout};
  planner::ChainTerms terms{layout.steps()};
  std::vector<double> iteration_ms;
  double total_ms = 0.0;
  double derivatives_ms = 0.0;
  double values_ms = 0.0;
  int solved = 0;

  explicit IterationSamples(const BenchSetup& setup) : model(setup.robot, setup.config.planner) {}

  void solve(const planner::PlanRequest& request) {
    const core::Result<planner::PlanarTask> task = planner::planar_task(model, request);
    if (!task) return;
    const planner::ChainProblem problem(model, *task, layout);
    const Eigen::VectorXd guess = planner::kinematic_guess(model, *task, layout);
    const Stopwatch watch(TimeOf::thread);
    const planner::ChainOutcome outcome =
        solver.solve(problem, guess, {model.config.iterations_max, model.config.tolerance});
    const double elapsed_ms = watch.milliseconds();
    if (outcome.status != planner::SolveStatus::solved) return;
    ++solved;
    iteration_ms.push_back(elapsed_ms / std::max(1, outcome.iterations));
    total_ms += iteration_ms.back();
    time_pieces(problem);
  }

  void time_pieces(const planner::ChainProblem& problem) {
    const planner::ChainLayout& chain = problem.layout();
    Eigen::VectorXd point = Eigen::VectorXd::Zero(chain.variables() + 1);
    point.head(chain.variables()) = solver.x();
    Eigen::VectorXd slots(chain.slots());
    Eigen::VectorXd equalities(chain.equalities());
    const Stopwatch watch(TimeOf::thread);
    problem.expand(point, solver.slot_multipliers(), solver.equality_multipliers(), terms);
    derivatives_ms += watch.milliseconds();
    const Stopwatch second(TimeOf::thread);
    (void)problem.values(point, slots, equalities);
    values_ms += second.milliseconds();
  }

  [[nodiscard]] nlohmann::ordered_json shares() const {
    const double derivatives = derivatives_ms / total_ms;
    const double values = 2.0 * values_ms / total_ms;  // of the trial and of the accepted point
    return {{"derivatives", derivatives},
            {"values", values},
            {"newton_step_and_rest", 1.0 - derivatives - values}};
  }
};

}  // namespace

nlohmann::ordered_json bench_planner(const BenchSetup& setup, int count) {
  planner::JumpPlanner planner(setup.config.planner, setup.robot,
                               shipped_jumps(setup.robot.name, setup.config.planner.steps));
  PlannerSamples cold;
  PlannerSamples closed_form;
  PlannerSamples warm;
  IpoptSamples ipopt(setup);
  ReplanSamples replanned(setup);
  IterationSamples iterations(setup);
  const std::vector<BenchTarget> targets = spread(read_targets(), static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < targets.size(); ++i) {
    planner::PlanRequest request = request_for(setup, targets[i]);
    request.id = i + 1;
    const core::Result<core::JumpPlan> plan = cold.plan(planner, request);
    if (plan && planner.rung() != planner::PlanRung::library) {
      replanned.replan(request, *plan, *planner.last());
    }
    planner::PlanRequest from_guess = request;
    from_guess.guess = planner::StartGuess::kinematic;
    (void)closed_form.plan(planner, from_guess);
    iterations.solve(request);
    BenchTarget neighbour = targets[i];
    neighbour.distance += i % 2 == 0 ? kMoved : -kMoved;
    if (planner.plan(request_for(setup, neighbour))) {
      planner::PlanRequest again = request;
      again.guess = planner::StartGuess::previous;
      (void)warm.plan(planner, again);
    }
    if (i % kIpoptEvery == 0) ipopt.solve(request);
  }
  const double all = static_cast<double>(targets.size());
  return {{"n", targets.size()},
          {"solver", "chain"},
          {"cold_ms", percentile_group(cold.plan_ms, 1.0)},
          {"cold_closed_form_ms", percentile_group(closed_form.plan_ms, 1.0)},
          {"warm_ms", percentile_group(warm.plan_ms, 1.0)},
          {"replan_ms", percentile_group(replanned.replan_ms, 1.0)},
          {"cold_iterations", percentile_group(cold.iterations, 1.0)},
          {"cold_closed_form_iterations", percentile_group(closed_form.iterations, 1.0)},
          {"warm_iterations", percentile_group(warm.iterations, 1.0)},
          {"replan_iterations", percentile_group(replanned.iterations, 1.0)},
          {"iteration_ms", percentile_group(iterations.iteration_ms, 1.0)},
          {"ipopt_ms", percentile_group(ipopt.solve_ms, 1.0)},
          {"success", cold.planned / all},  // certified plans
          {"certified", cold.planned / all},
          {"closed_form_success", closed_form.planned / all},
          {"solved_from_guess", iterations.solved / all},
          {"rungs", cold.rungs},
          {"dense_violation", percentile_group(cold.dense_violation, 1.0)},
          {"warm_success", warm.planned / std::max(1.0, static_cast<double>(warm.plan_ms.size()))},
          {"replan_success",
           replanned.planned / std::max(1.0, static_cast<double>(replanned.replan_ms.size()))},
          {"targets", targets.size()},
          {"shares", iterations.shares()}};
}

}  // namespace hopscotch::apps
