#include "planner/replanner.hpp"

#include <utility>

#include "planner/certified_plan.hpp"
#include "planner/jump_planner.hpp"
#include "planner/lift_to_3d.hpp"
#include "planner/planar_task.hpp"

namespace hopscotch::planner {

namespace {

using core::Reason;
using core::Refusal;

/// Solves of rests start close to their solution; a plan is waiting.
constexpr int kIterationsMax = 40;

double takeoff_step_mean(const PlannerConfig& config) {
  return config.takeoff_time() / config.steps.takeoff;
}

/// `from` without `count` entries at `at`.
void drop(Eigen::VectorXd& from, int at, int count) {
  const auto tail = from.size() - at - count;
  from.segment(at, tail) = from.tail(tail).eval();
  from.conservativeResize(at + tail);
}

}  // namespace

PlannerConfig config_of_rest(PlannerConfig config, int steps_done) {
  const double time = config.takeoff_time();
  const double mean = takeoff_step_mean(config);
  const int steps = config.steps.takeoff;
  config.takeoff_first_step = config.takeoff_step(steps_done);
  config.steps.takeoff -= steps_done;
  const double share = config.takeoff_time() / time;
  for (double* weight :
       {&config.takeoff_cost.posture, &config.takeoff_cost.rate, &config.takeoff_cost.torque,
        &config.takeoff_cost.acceleration, &config.takeoff_cost.trunk_pitch}) {
    *weight *= share;
  }
  config.smoothness_cost *= config.steps.takeoff * mean / (steps * takeoff_step_mean(config));
  return config;
}

KnownJump rest_of(const KnownJump& jump, const StepCounts& steps, int steps_done) {
  const ChainLayout layout{DecisionLayout(steps)};
  const int variables = layout.decision().takeoff(steps_done);
  KnownJump rest = jump;
  ChainSolution& solution = rest.solution;
  // From the back, so that what is in front stays where it was.
  drop(solution.slot_multipliers, layout.variable(0), variables);
  drop(solution.slot_multipliers, layout.takeoff_joints(0), kStanceDof * steps_done);
  drop(solution.slot_multipliers, layout.takeoff_rows(0), ChainLayout::kStanceRows * steps_done);
  drop(solution.equality_multipliers, layout.takeoff_gap(0), kStanceDof * steps_done);
  drop(solution.x, 0, variables);
  rest.correction.erase(rest.correction.begin(), rest.correction.begin() + steps_done);
  return rest;
}

/// The program of a rest of one length.
struct Replanner::Rest {
  PlanarModel model;
  CorrectedSolver solver;

  Rest(const PlannerConfig& config, const model::RobotParameters& robot)
      : model(robot, config), solver(DecisionLayout(config.steps)) {
    solver.allow(kIterationsMax);
  }
};

Replanner::Replanner(const PlannerConfig& config, const model::RobotParameters& robot)
    : config_(config), robot_(robot) {}
Replanner::~Replanner() = default;

Replanner::Rest& Replanner::rest_after(int steps_done) {
  std::unique_ptr<Rest>& rest = rests_[steps_done];
  if (!rest) rest = std::make_unique<Rest>(config_of_rest(config_, steps_done), robot_);
  return *rest;
}

KnownJump Replanner::in_hand(const RestRequest& request) {
  const bool goes_on = id_ == request.id && last_begin_ <= request.steps_done;
  if (!goes_on) {
    id_ = request.id;
    last_ = request.whole;
    last_begin_ = 0;
  }
  StepCounts steps = config_.steps;
  steps.takeoff -= last_begin_;
  return rest_of(*last_, steps, request.steps_done - last_begin_);
}

core::Result<core::JumpPlan> Replanner::replan(const RestRequest& request) {
  iterations_ = 0;
  if (request.steps_done < 0 || request.steps_done > config_.steps.takeoff - kStepsLeftMin) {
    return Refusal{Reason::target_malformed,
                   "no more than the last steps of the takeoff are left to plan"};
  }
  if (!side_target(request.target).is_straight()) {
    return Refusal{Reason::out_of_reach, "only jumps straight ahead are planned anew"};
  }
  auto& [model, solver] = rest_after(request.steps_done);
  const core::Result<PlanarTask> task = planar_task(
      model,
      {.start = request.state, .target = request.target, .final_posture = request.final_posture});
  if (!task) return task.error();
  const SolvedMotion solved = solver.solve_near(model, *task, in_hand(request));
  iterations_ = solved.outcome.iterations;
  // The plan in hand is one; a half-solved one that only looks possible is none.
  const bool converged = solved.outcome.status == SolveStatus::solved;
  if (!converged || !is_acceptable(solved.outcome))
    return infeasible(solved.outcome, *task, solver.obstacle());
  core::JumpPlan plan;
  plan.id = request.id;
  plan.stamp = request.state.stamp;
  plan.target = request.target;
  plan.status = core::PlanStatus::solved;
  plan.iterations = iterations_;
  plan.warm = true;
  if (auto refusal = certify_and_lift(model, *task, solved, kDenseViolationMax, plan)) {
    return *std::move(refusal);
  }
  last_ = std::make_shared<const KnownJump>(solver.known(*task, solved));
  last_begin_ = request.steps_done;
  return plan;
}

}  // namespace hopscotch::planner
