#include "planner/corrected_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planner/slot_names.hpp"

namespace hopscotch::planner {

namespace {

constexpr double kViolationMax = 5e-3;
/// Iterations after which a warm start counts as a bad one.
constexpr int kWarmIterationsMax = 25;

// Deferred correction of a solution.
constexpr int kPolishIterations = 80;     // in all
constexpr int kPolishIterationsMax = 25;  // of one pass
constexpr double kPolishViolationMax = 1e-3;
/// A pass that leaves more has no solution nearby, unless it left clearly more before.
constexpr double kPolishHopeless = 1e-2;
constexpr double kPolishProgress = 0.9;
/// A pass that leaves more of the defect may have overshot: what was active is not any more, and
/// comes back with the next one. From the second such pass on corrections go half of their way.
constexpr double kOvershoot = 0.8;
constexpr int kOvershootsMax = 1;

double half_way(double from, double to) {
  return std::isfinite(from) && std::isfinite(to) ? 0.5 * (from + to) : to;
}

void go_half_way(const ChainCorrection& from, ChainCorrection& to) {
  for (std::size_t i = 0; i < to.steps.size(); ++i) {
    for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
      double& turn = to.steps[i].turn[j];
      double& acceleration = to.steps[i].acceleration[j];
      turn = half_way(from.steps[i].turn[j], turn);
      acceleration = half_way(from.steps[i].acceleration[j], acceleration);
    }
  }
  for (Eigen::Index r = 0; r < to.lower.size(); ++r) {
    to.lower(r) = half_way(from.lower(r), to.lower(r));
    to.upper(r) = half_way(from.upper(r), to.upper(r));
  }
}

}  // namespace

bool is_acceptable(const SolveOutcome& outcome) {
  return (outcome.status == SolveStatus::solved ||
          outcome.status == SolveStatus::iteration_limit) &&
         outcome.violation <= kViolationMax;
}

PlanarMotion motion_of(const KnownJump& jump, const PlanarModel& model, const PlanarTask& task,
                       const DecisionLayout& layout) {
  PlanarMotion motion = motion_from_decision(model, task, layout, jump.solution.x);
  for (std::size_t i = 0; i < jump.correction.size(); ++i) {
    motion.knots[i].correction = jump.correction[i];
  }
  return motion;
}

CorrectedSolver::CorrectedSolver(const DecisionLayout& layout)
    : layout_(layout),
      chain_(layout),
      correction_(ChainLayout(layout)),
      last_correction_(correction_) {}

SolvedMotion CorrectedSolver::solve(const PlanarModel& model, const PlanarTask& task,
                                    const Eigen::VectorXd& start) {
  ChainProblem problem(model, task, layout_);
  correction_.clear();
  problem.correct(correction_);
  // It may take two attempts.
  const int allowed = std::max(1, allowed_ / 2);
  const SolveOptions options{std::min(allowed, model.config.iterations_max),
                             model.config.tolerance};
  return corrected(model, task, problem, chain_.solve(problem, start, options));
}

SolvedMotion CorrectedSolver::solve_near(const PlanarModel& model, const PlanarTask& task,
                                         const KnownJump& neighbour) {
  ChainProblem problem(model, task, layout_);
  correction_.clear_bounds();
  correction_.steps = neighbour.correction;
  problem.correct(correction_);
  const SolveOptions options{std::min({allowed_, kWarmIterationsMax, model.config.iterations_max}),
                             model.config.tolerance};
  return corrected(model, task, problem, chain_.solve_near(problem, neighbour.solution, options));
}

KnownJump CorrectedSolver::known(const PlanarTask& task, const SolvedMotion& solved) const {
  KnownJump jump{task.start, task.distance, task.height, best_, {}};
  for (std::size_t i = 0; i < correction_.steps.size(); ++i) {
    jump.correction.push_back(solved.motion.knots[i].correction);
  }
  return jump;
}

SolvedMotion CorrectedSolver::corrected(const PlanarModel& model, const PlanarTask& task,
                                        ChainProblem& problem, const ChainOutcome& solved) {
  obstacle_ = slot_name(problem.layout(), chain_.tightest_slot());
  SolvedMotion out{{solved.status, solved.iterations, solved.violation, solved.cost, chain_.x()},
                   motion_from_decision(model, task, layout_, chain_.x())};
  set_correction(correction_, out.motion);
  best_ = chain_.solution();
  if (is_acceptable(out.outcome)) refine(model, task, problem, out);
  return out;
}

/// Solves again with what the motion misses between its knots, and keeps the motion that misses
/// least.
void CorrectedSolver::refine(const PlanarModel& model, const PlanarTask& task,
                             ChainProblem& problem, SolvedMotion& best) {
  PlanarMotion motion = best.motion;
  const auto examine = [&] {
    return update_correction(model, task, problem.layout(), {motion, chain_.slot_values()},
                             correction_)
        .worst();
  };
  double least = examine();
  double defect = least;
  double violation = kUnbounded;
  int overshoots = 0;
  const int granted = std::min(kPolishIterations, allowed_ - best.outcome.iterations);
  int left = granted;
  while (left > 0 && defect > kDefectWanted) {
    if (overshoots > kOvershootsMax) go_half_way(last_correction_, correction_);
    problem.correct(correction_);
    const SolveOptions options{std::min(left, kPolishIterationsMax), model.config.tolerance, 1};
    const ChainOutcome solved = chain_.polish(problem, options);
    left -= std::max(1, solved.iterations);
    motion = motion_from_decision(model, task, layout_, chain_.x());
    set_correction(correction_, motion);
    last_correction_ = correction_;
    const double last_defect = std::exchange(defect, examine());
    if (defect > kOvershoot * last_defect) ++overshoots;
    const double progress = solved.violation / violation;
    violation = solved.violation;
    if (violation > kPolishHopeless && progress > kPolishProgress) break;
    if (defect >= least || solved.violation > kPolishViolationMax) continue;
    least = defect;
    best.motion = motion;
    best.outcome.violation = solved.violation;
    best.outcome.cost = solved.cost;
    best.outcome.x = chain_.x();
    best_ = chain_.solution();
  }
  best.outcome.iterations += granted - left;
}

}  // namespace hopscotch::planner
