#include "planner/replanner.hpp"

#include <algorithm>
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

void scale(double share, CostWeights& cost) {
  for (double* weight :
       {&cost.posture, &cost.rate, &cost.torque, &cost.acceleration, &cost.trunk_pitch}) {
    *weight *= share;
  }
}

PlannerConfig later_takeoff(PlannerConfig config, int steps_left) {
  const double time = config.takeoff_time();
  const double mean = takeoff_step_mean(config);
  const int steps = config.steps.takeoff;
  config.takeoff_first_step = config.takeoff_step(steps - steps_left);
  config.steps.takeoff = steps_left;
  scale(config.takeoff_time() / time, config.takeoff_cost);
  config.smoothness_cost *= steps_left * mean / (steps * takeoff_step_mean(config));
  return config;
}

/// The mean of the last landing steps, in units of dt^l.
double landing_share_mean(const PlannerConfig& config, int steps_left) {
  const int steps = config.steps.landing;
  return 0.5 * (config.landing_share(steps - steps_left) + config.landing_share(steps - 1));
}

/// dt^l is the mean of the steps that are left.
PlannerConfig later_landing(PlannerConfig config, int steps_left) {
  const int steps = config.steps.landing;
  const double mean = landing_share_mean(config, steps_left);
  for (double* step :
       {&config.landing_step_min, &config.landing_step_max, &config.landing_step_hard}) {
    *step *= mean;
  }
  config.landing_first_share = config.landing_share(steps - steps_left) / mean;
  // The room at toe and heel was kept for what the landing has met by now.
  config.landing_cop_margin = std::min(config.landing_cop_margin, config.takeoff_cop_margin);
  config.steps = {0, 0, steps_left};
  scale(mean * steps_left / steps, config.landing_cost);
  return config;
}

/// `from` without `count` entries at `at`.
void drop(Eigen::VectorXd& from, int at, int count) {
  const auto tail = from.size() - at - count;
  from.segment(at, tail) = from.tail(tail).eval();
  from.conservativeResize(at + tail);
}

KnownJump without_takeoff_steps(const KnownJump& jump, const StepCounts& steps, int done) {
  const ChainLayout layout{DecisionLayout(steps)};
  const int variables = layout.decision().takeoff(done);
  KnownJump rest = jump;
  ChainSolution& solution = rest.solution;
  // From the back, so that what is in front stays where it was.
  drop(solution.slot_multipliers, layout.variable(0), variables);
  drop(solution.slot_multipliers, layout.takeoff_joints(0), kStanceDof * done);
  drop(solution.slot_multipliers, layout.takeoff_rows(0), ChainLayout::kStanceRows * done);
  drop(solution.equality_multipliers, layout.takeoff_gap(0), kStanceDof * done);
  drop(solution.x, 0, variables);
  rest.correction.erase(rest.correction.begin(), rest.correction.begin() + done);
  return rest;
}

/// Copies what two layouts have in common of the landing's last steps.
class LandingPart {
 public:
  LandingPart(const StepCounts& whole, const StepCounts& rest)
      : from_(DecisionLayout(whole)),
        to_(DecisionLayout(rest)),
        done_(whole.landing - rest.landing) {}

  /// From knot 1 of the rest on; what is at its start is fixed.
  void copy_variables(const Eigen::VectorXd& whole, int from, Eigen::VectorXd& rest, int to) const {
    const DecisionLayout& left = to_.decision();
    const DecisionLayout& all = from_.decision();
    const int count = left.landing(to_.steps().landing + 1) - left.landing(1);
    rest.segment(to + left.landing(1), count) = whole.segment(from + all.landing(done_ + 1), count);
    rest(to + left.landing_step()) = whole(from + all.landing_step());
  }

  [[nodiscard]] ChainSolution of(const ChainSolution& whole) const {
    const int steps = to_.steps().landing;
    const Eigen::VectorXd& slots = whole.slot_multipliers;
    ChainSolution rest{
        Eigen::VectorXd::Zero(to_.variables()), Eigen::VectorXd::Zero(to_.slots()),
        whole.equality_multipliers.segment(from_.landing_gap(done_), kStanceDof * steps)};
    copy_variables(whole.x, 0, rest.x, 0);
    copy_variables(slots, from_.variable(0), rest.slot_multipliers, to_.variable(0));
    rest.slot_multipliers.segment(to_.landing_rows(0), ChainLayout::kStanceRows * steps) =
        slots.segment(from_.landing_rows(done_), ChainLayout::kStanceRows * steps);
    rest.slot_multipliers.segment(to_.landing_joints(1), kStanceDof * (steps - 1)) =
        slots.segment(from_.landing_joints(done_ + 1), kStanceDof * (steps - 1));
    return rest;
  }

 private:
  ChainLayout from_;
  ChainLayout to_;
  int done_;
};

KnownJump landing_of(const KnownJump& jump, const PlannerConfig& config, const StepCounts& rest) {
  KnownJump landing = jump;
  landing.solution = LandingPart(config.steps, rest).of(jump.solution);
  landing.solution.x(DecisionLayout(rest).landing_step()) *=
      landing_share_mean(config, rest.landing);
  landing.correction.erase(landing.correction.begin(), landing.correction.end() - rest.landing);
  return landing;
}

}  // namespace

std::optional<StepCounts> rest_steps(const StepCounts& whole, int steps_done) {
  StepCounts rest = whole;
  if (steps_done >= 0 && steps_done <= whole.takeoff - kRestStepsMin) {
    rest.takeoff -= steps_done;
    return rest;
  }
  const int landed = steps_done - whole.takeoff - whole.flight;
  if (landed < 0 || landed > whole.landing - kRestStepsMin) return std::nullopt;
  return StepCounts{0, 0, whole.landing - landed};
}

int landing_steps_begun(const PlannerConfig& config, const KnownJump& jump,
                        double since_touchdown) {
  const double step = jump.solution.x(DecisionLayout(config.steps).landing_step());
  int begun = 0;
  for (double begin = 0.0; begun < config.steps.landing && begin < since_touchdown; ++begun) {
    begin += config.landing_share(begun) * step;
  }
  return begun;
}

PlannerConfig config_of_rest(PlannerConfig config, const StepCounts& rest) {
  if (!rest.landed()) return later_takeoff(config, rest.takeoff);
  return later_landing(config, rest.landing);
}

KnownJump rest_of(const KnownJump& jump, const PlannerConfig& config, const StepCounts& rest) {
  if (rest.landed()) return landing_of(jump, config, rest);
  return without_takeoff_steps(jump, config.steps, config.steps.takeoff - rest.takeoff);
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

Replanner::Rest& Replanner::rest_after(int steps_done, const StepCounts& steps) {
  std::unique_ptr<Rest>& rest = rests_[steps_done];
  if (!rest) rest = std::make_unique<Rest>(config_of_rest(config_, steps), robot_);
  return *rest;
}

KnownJump Replanner::in_hand(const RestRequest& request, const StepCounts& rest) {
  if (id_ != request.id || last_begin_ > request.steps_done) {
    id_ = request.id;
    last_ = request.whole;
    last_begin_ = 0;
  }
  const StepCounts steps = *rest_steps(config_.steps, last_begin_);
  return rest_of(*last_, config_of_rest(config_, steps), rest);
}

core::Result<core::JumpPlan> Replanner::replan(const RestRequest& request) {
  iterations_ = 0;
  const std::optional<StepCounts> steps = rest_steps(config_.steps, request.steps_done);
  if (!steps) {
    return Refusal{Reason::target_malformed,
                   "no more than the last steps of takeoff or landing are left to plan"};
  }
  if (!side_target(request.target).is_straight()) {
    return Refusal{Reason::out_of_reach, "only jumps straight ahead are planned anew"};
  }
  auto& [model, solver] = rest_after(request.steps_done, *steps);
  const core::Result<PlanarTask> task = planar_task(
      model,
      {.start = request.state, .target = request.target, .final_posture = request.final_posture},
      steps->landed() ? FeetPlace::target : FeetPlace::origin);
  if (!task) return task.error();
  const SolvedMotion solved = solver.solve_near(model, *task, in_hand(request, *steps));
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
  if (auto refusal = certify_and_lift(model, *task, solved, plan)) {
    return *std::move(refusal);
  }
  last_ = std::make_shared<const KnownJump>(solver.known(*task, solved));
  last_begin_ = request.steps_done;
  return plan;
}

}  // namespace hopscotch::planner
