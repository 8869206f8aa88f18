#include "planner/jump_planner.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "planner/certificate.hpp"
#include "planner/chain_solver.hpp"
#include "planner/ipopt_problem.hpp"
#include "planner/landing_phase.hpp"
#include "planner/lift_to_3d.hpp"
#include "planner/planar_task.hpp"
#include "planner/warm_start.hpp"

namespace hopscotch::planner {

namespace {

using core::Reason;
using core::Refusal;

/// Rows and bounds may be missed by so much (shares of limits, metres, radians) before a solution
/// counts as none; the certificate then judges with the true limits.
constexpr double kViolationMax = 5e-3;
/// A margin below zero by less is rounding of the solver.
constexpr double kMarginTolerance = 1e-3;
/// Joint motion re-integrated with the held torques may miss by so much, see `certify`.
constexpr double kDenseViolationMax = 0.10;

NonlinearProgram build_program(const PlanarModel& model, const PlanarTask& task,
                               const DecisionLayout& layout) {
  BlockList blocks;
  add_takeoff(model, task, layout, blocks);
  add_flight(model, task, layout, blocks);
  add_landing(model, task, layout, blocks);
  return {layout.size(), std::move(blocks)};
}

Refusal infeasible(const SolveOutcome& outcome, const PlanarTask& task) {
  char text[160];
  std::snprintf(text, sizeof text,
                "no motion found to %.3f m, height %.3f m: %s after %d iterations, largest "
                "violation %.2g",
                task.distance, task.height,
                outcome.status == SolveStatus::iteration_limit ? "stopped" : "gave up",
                outcome.iterations, outcome.violation);
  return {Reason::plan_infeasible, text};
}

Refusal not_certified(const core::Certificate& certificate) {
  const core::CertificateEntry& worst = certificate.binding();
  char text[160];
  std::snprintf(text, sizeof text,
                "%s has margin %.3f at %.3f s; largest dense violation %.3f (allowed %.3f)",
                std::string(worst.name).c_str(), worst.margin, worst.time,
                certificate.dense_max_violation, kDenseViolationMax);
  return {Reason::certificate_refused, text};
}

bool acceptable(const SolveOutcome& outcome) {
  return (outcome.status == SolveStatus::solved ||
          outcome.status == SolveStatus::iteration_limit) &&
         outcome.violation <= kViolationMax;
}

}  // namespace

struct JumpPlanner::Memory {
  PlanarModel model;
  DecisionLayout layout;
  ChainSolver chain;
  bool chain_is_solved = false;  ///< The chain solver holds a certified jump with its multipliers.
  Eigen::VectorXd previous;      ///< The last certified jump; empty before the first.

  Memory(const model::RobotParameters& robot, const PlannerConfig& config)
      : model(robot, config), layout(config.steps), chain(layout) {}

  [[nodiscard]] SolveOutcome solve(const PlanarTask& task, Solver solver, StartGuess guess);
};

SolveOutcome JumpPlanner::Memory::solve(const PlanarTask& task, Solver solver, StartGuess guess) {
  const bool warm = guess == StartGuess::previous;
  const SolveOptions options{model.config.iterations_max, model.config.tolerance};
  if (solver == Solver::ipopt) {
    const StartPoint start{warm ? previous : kinematic_guess(model, task, layout)};
    return solve_with_ipopt(build_program(model, task, layout),
                            decision_bounds(model, task, layout), decision_sizes(layout), start,
                            options);
  }
  const ChainProblem problem(model, task, layout);
  ChainOutcome solved;
  if (warm && chain_is_solved) {
    solved = chain.solve_again(problem, options);
  } else {
    solved = chain.solve(problem, warm ? previous : kinematic_guess(model, task, layout), options);
  }
  chain_is_solved = false;
  return {solved.status, solved.iterations, solved.violation, solved.cost, chain.x()};
}

JumpPlanner::JumpPlanner(const PlannerConfig& config, const model::RobotParameters& robot)
    : memory_(std::make_unique<Memory>(robot, config)) {
  const StepCounts& steps = config.steps;
  const int knots = steps.takeoff + steps.flight + steps.landing + 1;
  if (knots > static_cast<int>(core::JumpPlan::kMaxKnots)) {
    throw std::invalid_argument("planner.steps: together at most " +
                                std::to_string(core::JumpPlan::kMaxKnots - 1));
  }
}

JumpPlanner::~JumpPlanner() = default;
JumpPlanner::JumpPlanner(JumpPlanner&&) noexcept = default;
JumpPlanner& JumpPlanner::operator=(JumpPlanner&&) noexcept = default;

core::Result<core::JumpPlan> JumpPlanner::plan(const PlanRequest& request) {
  const PlanarModel& model = memory_->model;
  const DecisionLayout& layout = memory_->layout;
  const core::Result<PlanarTask> task = planar_task(model, request);
  if (!task) return task.error();

  const bool warm = request.guess == StartGuess::previous && memory_->previous.size() > 0;
  const SolveOutcome outcome =
      memory_->solve(*task, request.solver, warm ? StartGuess::previous : StartGuess::kinematic);
  if (!acceptable(outcome)) return infeasible(outcome, *task);

  const PlanarMotion motion = motion_from_decision(model, *task, layout, outcome.x);
  CertifiedMotion certified = certify(model, *task, motion);
  certified.certificate.max_violation = outcome.violation;
  if (certified.certificate.binding().margin < -kMarginTolerance ||
      certified.certificate.dense_max_violation > kDenseViolationMax) {
    return not_certified(certified.certificate);
  }
  memory_->previous = outcome.x;
  memory_->chain_is_solved = request.solver == Solver::chain;

  core::JumpPlan plan;
  plan.id = request.id;
  plan.stamp = request.start.stamp;
  plan.target = request.target;
  plan.status = outcome.status == SolveStatus::solved ? core::PlanStatus::solved
                                                      : core::PlanStatus::iteration_limit;
  plan.iterations = outcome.iterations;
  plan.warm = warm;
  plan.certificate = certified.certificate;
  plan.peaks = certified.peaks;
  lift_to_3d(model, motion, request.target, plan);
  return plan;
}

}  // namespace hopscotch::planner
