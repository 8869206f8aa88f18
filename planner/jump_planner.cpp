#include "planner/jump_planner.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

#include "planner/certificate.hpp"
#include "planner/chain_correction.hpp"
#include "planner/chain_solver.hpp"
#include "planner/ipopt_problem.hpp"
#include "planner/landing_phase.hpp"
#include "planner/leg_certificate.hpp"
#include "planner/lift_to_3d.hpp"
#include "planner/planar_task.hpp"
#include "planner/slot_names.hpp"
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
constexpr double kDenseViolationMax = 1e-3;
/// The same of a solution of Ipopt, which nothing corrects between its knots.
constexpr double kUncorrectedViolationMax = 0.10;

/// A warm start that takes longer was a bad one: from the closed-form guess instead.
constexpr int kWarmIterationsMax = 25;

// Deferred correction of a solution.
constexpr int kPolishIterations = 50;     // in all
constexpr int kPolishIterationsMax = 25;  // of one pass
constexpr double kPolishViolationMax = 1e-3;
/// A pass that leaves more has no solution nearby.
constexpr double kPolishHopeless = 1e-2;
/// Dynamics between the knots and limits beyond it are good: an aim that leaves room below the
/// tolerance of the certificate.
constexpr double kDefectWanted = 7e-4;

/// A jump to the side or with a turn loads one leg more, slides it sideways and reaches further
/// with it: it uses so much less of each reserve, and the certificate judges each leg.
constexpr double kSideShare = 0.94;

PlannerConfig with_room_for_one_leg(PlannerConfig config) {
  for (double* share : {&config.reserves.torque, &config.reserves.speed, &config.reserves.friction,
                        &config.reserves.power}) {
    *share *= kSideShare;
  }
  return config;
}

/// A solution and its motion.
struct SolvedMotion {
  SolveOutcome outcome;
  PlanarMotion motion;
};

NonlinearProgram build_program(const PlanarModel& model, const PlanarTask& task,
                               const DecisionLayout& layout) {
  BlockList blocks;
  add_takeoff(model, task, layout, blocks);
  add_flight(model, task, layout, blocks);
  add_landing(model, task, layout, blocks);
  return {layout.size(), std::move(blocks)};
}

Refusal infeasible(const SolveOutcome& outcome, const PlanarTask& task, std::string_view limit) {
  char text[200];
  std::snprintf(text, sizeof text,
                "no motion found to %.3f m, height %.3f m: %s after %d iterations, largest "
                "violation %.2g",
                task.distance, task.height,
                outcome.status == SolveStatus::iteration_limit ? "stopped" : "gave up",
                outcome.iterations, outcome.violation);
  const std::string by = limit.empty() ? "" : "; stopped by " + std::string(limit);
  return {Reason::plan_infeasible, text + by};
}

double violation_max(Solver solver) {
  return solver == Solver::chain ? kDenseViolationMax : kUncorrectedViolationMax;
}

Refusal not_certified(const core::Certificate& certificate, Solver solver) {
  const core::CertificateEntry& worst = certificate.binding();
  char text[160];
  std::snprintf(text, sizeof text,
                "%s has margin %.3f at %.3f s; largest dense violation %.3f (allowed %.3f)",
                std::string(worst.name).c_str(), worst.margin, worst.time,
                certificate.dense_max_violation, violation_max(solver));
  return {Reason::certificate_refused, text};
}

bool is_certified(const core::Certificate& certificate, Solver solver) {
  return certificate.binding().margin >= -kMarginTolerance &&
         certificate.dense_max_violation <= violation_max(solver);
}

/// Fills certificate, peaks and knots of a plan whose target is set. @return why it is refused.
std::optional<Refusal> certify_and_lift(const PlanarModel& model, const PlanarTask& task,
                                        const SolvedMotion& solved, Solver solver,
                                        core::JumpPlan& plan) {
  const PlanarMotion& motion = solved.motion;
  const CertifiedMotion certified = certify(model, task, motion);
  plan.certificate = certified.certificate;
  plan.certificate.max_violation = solved.outcome.violation;
  plan.peaks = certified.peaks;
  if (!is_certified(plan.certificate, solver)) return not_certified(plan.certificate, solver);
  if (!lift_to_3d(model, motion, plan.target, plan)) {
    return Refusal{Reason::out_of_reach, "a leg cannot reach so far to the side"};
  }
  if (!side_target(plan.target).is_straight()) {
    certify_legs(model.robot, model.config.friction, plan);
  }
  if (!is_certified(plan.certificate, solver)) return not_certified(plan.certificate, solver);
  return std::nullopt;
}

core::JumpPlan plan_for(const PlanRequest& request, const SolveOutcome& outcome) {
  core::JumpPlan plan;
  plan.id = request.id;
  plan.stamp = request.start.stamp;
  plan.target = request.target;
  plan.status = outcome.status == SolveStatus::solved ? core::PlanStatus::solved
                                                      : core::PlanStatus::iteration_limit;
  plan.iterations = outcome.iterations;
  return plan;
}

bool acceptable(const SolveOutcome& outcome) {
  return (outcome.status == SolveStatus::solved ||
          outcome.status == SolveStatus::iteration_limit) &&
         outcome.violation <= kViolationMax;
}

}  // namespace

struct JumpPlanner::Memory {
  PlanarModel straight;  ///< For jumps ahead.
  PlanarModel sideways;  ///< For the others: what one leg may use more than the other is kept.
  DecisionLayout layout;
  ChainSolver chain;
  ChainCorrection correction;    ///< Of the last solve.
  bool chain_is_solved = false;  ///< The chain solver holds a certified jump with its multipliers.
  Eigen::VectorXd previous;      ///< The last certified jump; empty before the first.
  std::string_view obstacle;     ///< Limit that the last refusal is about.
  int iterations = 0;            ///< Of the last solve.

  Memory(const model::RobotParameters& robot, const PlannerConfig& config)
      : straight(robot, config),
        sideways(robot, with_room_for_one_leg(config)),
        layout(config.steps),
        chain(layout),
        correction(ChainLayout(layout)) {}

  [[nodiscard]] SolvedMotion solve(const PlanarModel& model, const PlanarTask& task,
                                   const PlanRequest& request, StartGuess guess);
  [[nodiscard]] ChainOutcome solve_chain(const PlanarModel& model, const PlanarTask& task,
                                         ChainProblem& problem, StartGuess guess);
  void refine(const PlanarModel& model, const PlanarTask& task, ChainProblem& problem,
              SolvedMotion& best);
  [[nodiscard]] core::Result<core::JumpPlan> plan_otherwise(const PlanRequest& request,
                                                            const PlanarTask& task);
};

SolvedMotion JumpPlanner::Memory::solve(const PlanarModel& model, const PlanarTask& task,
                                        const PlanRequest& request, StartGuess guess) {
  const bool warm = guess == StartGuess::previous;
  const SolveOptions options{model.config.iterations_max, model.config.tolerance};
  obstacle = {};
  if (request.solver == Solver::ipopt) {
    const StartPoint start{warm ? previous : kinematic_guess(model, task, layout)};
    const SolveOutcome solved =
        solve_with_ipopt(build_program(model, task, layout), decision_bounds(model, task, layout),
                         decision_sizes(layout), start, options);
    return {solved, motion_from_decision(model, task, layout, solved.x)};
  }
  ChainProblem problem(model, task, layout);
  const ChainOutcome solved = solve_chain(model, task, problem, guess);
  chain_is_solved = false;
  obstacle = slot_name(problem.layout(), chain.tightest_slot());
  SolvedMotion out{{solved.status, solved.iterations, solved.violation, solved.cost, chain.x()},
                   motion_from_decision(model, task, layout, chain.x())};
  set_correction(correction, out.motion);
  if (acceptable(out.outcome)) refine(model, task, problem, out);
  return out;
}

/// From the last jump and what it missed between its knots, else from a guess.
ChainOutcome JumpPlanner::Memory::solve_chain(const PlanarModel& model, const PlanarTask& task,
                                              ChainProblem& problem, StartGuess guess) {
  SolveOptions options{model.config.iterations_max, model.config.tolerance};
  int spent = 0;
  const bool warm = guess == StartGuess::previous;
  if (warm && chain_is_solved) {
    correction.clear_bounds();
    problem.correct(correction);
    options.iterations_max = kWarmIterationsMax;
    const ChainOutcome solved = chain.solve_again(problem, options);
    if (solved.status == SolveStatus::solved) return solved;
    spent = solved.iterations;
    options.iterations_max = model.config.iterations_max;
  }
  correction.clear();
  problem.correct(correction);
  const bool far = !warm || chain_is_solved;
  ChainOutcome solved =
      chain.solve(problem, far ? kinematic_guess(model, task, layout) : previous, options);
  solved.iterations += spent;
  return solved;
}

/// Deferred correction: solves again with what the motion misses between its knots, and keeps the
/// motion that misses least.
void JumpPlanner::Memory::refine(const PlanarModel& model, const PlanarTask& task,
                                 ChainProblem& problem, SolvedMotion& best) {
  PlanarMotion motion = best.motion;
  const auto examine = [&] {
    return update_correction(model, task, problem.layout(), {motion, chain.slot_values()},
                             correction)
        .worst();
  };
  double least = examine();
  double defect = least;
  int left = kPolishIterations;
  while (left > 0 && defect > kDefectWanted) {
    problem.correct(correction);
    const SolveOptions options{std::min(left, kPolishIterationsMax), model.config.tolerance, 1};
    const ChainOutcome solved = chain.polish(problem, options);
    left -= std::max(1, solved.iterations);
    motion = motion_from_decision(model, task, layout, chain.x());
    set_correction(correction, motion);
    defect = examine();
    if (solved.violation > kPolishHopeless) break;
    if (defect >= least || solved.violation > kPolishViolationMax) continue;
    least = defect;
    best.motion = motion;
    best.outcome.violation = solved.violation;
    best.outcome.cost = solved.cost;
    best.outcome.x = chain.x();
  }
  best.outcome.iterations += kPolishIterations - left;
}

/// By a formulation that is compared with the planner's own.
core::Result<core::JumpPlan> JumpPlanner::Memory::plan_otherwise(const PlanRequest& request,
                                                                 const PlanarTask& task) {
  if (!side_target(request.target).is_straight()) {
    return Refusal{Reason::target_malformed, "this formulation plans jumps straight ahead only"};
  }
  const FormulatedJump solved = solve_formulation(request.formulation, straight, task);
  iterations = solved.outcome.iterations;
  if (solved.outcome.status != SolveStatus::solved) return infeasible(solved.outcome, task, {});
  core::JumpPlan plan = plan_for(request, solved.outcome);
  const CertifiedMotion certified = certify(straight, task, solved.motion);
  plan.certificate = certified.certificate;
  plan.certificate.max_violation = solved.outcome.violation;
  plan.peaks = certified.peaks;
  if (!lift_to_3d(straight, solved.motion, plan.target, plan)) {
    return Refusal{Reason::out_of_reach, "a leg cannot reach so far"};
  }
  return plan;
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

std::string_view JumpPlanner::obstacle() const {
  return memory_->obstacle;
}

int JumpPlanner::iterations() const {
  return memory_->iterations;
}

JumpPlanner::~JumpPlanner() = default;
JumpPlanner::JumpPlanner(JumpPlanner&&) noexcept = default;
JumpPlanner& JumpPlanner::operator=(JumpPlanner&&) noexcept = default;

core::Result<core::JumpPlan> JumpPlanner::plan(const PlanRequest& request) {
  const bool straight = side_target(request.target).is_straight();
  const PlanarModel& model = straight ? memory_->straight : memory_->sideways;
  memory_->obstacle = {};
  memory_->iterations = 0;
  const core::Result<PlanarTask> task = planar_task(model, request);
  if (!task) return task.error();
  if (request.formulation != Formulation::variable) return memory_->plan_otherwise(request, *task);

  const bool warm = request.guess == StartGuess::previous && memory_->previous.size() > 0;
  const SolvedMotion solved =
      memory_->solve(model, *task, request, warm ? StartGuess::previous : StartGuess::kinematic);
  const SolveOutcome& outcome = solved.outcome;
  memory_->iterations = outcome.iterations;
  if (!acceptable(outcome)) return infeasible(outcome, *task, memory_->obstacle);

  core::JumpPlan plan = plan_for(request, outcome);
  plan.warm = warm;
  if (std::optional<Refusal> refusal =
          certify_and_lift(model, *task, solved, request.solver, plan)) {
    memory_->obstacle = plan.certificate.binding().name;
    return *refusal;
  }
  memory_->previous = outcome.x;
  memory_->chain_is_solved = request.solver == Solver::chain;
  return plan;
}

}  // namespace hopscotch::planner
