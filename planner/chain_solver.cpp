#include "planner/chain_solver.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::planner {

namespace {

// Start.
constexpr double kPush = 0.3;        // of slacks into their bounds, as a share of the range
constexpr double kSecondPush = 0.4;  // of a second attempt
constexpr double kBarrierStart = 0.1;
/// A first attempt that ends further from feasible is not worth a second one.
constexpr double kSecondViolationMax = 0.05;
// Barrier.
constexpr double kBarrierFactor = 0.1;
constexpr double kBarrierPower = 1.5;
constexpr double kBarrierShare = 30.0;       // error below which a barrier problem counts as solved
constexpr double kBarrierEnd = 0.01;         // last barrier as a share of the tolerance
constexpr double kComplementarityEnd = 5.0;  // times the last barrier, at the solution
constexpr double kKeepMin = 0.99;            // fraction to the boundary
constexpr double kMultiplierScale = 100.0;
/// Curvature added to each scaled variable where the Hessian's indefinite part is left out.
constexpr double kRegularisation = 1e-6;
// Filter.
constexpr double kViolationGain = 1e-5;
constexpr double kMeritGain = 1e-8;
constexpr double kSwitchMerit = 2.3;
constexpr double kSwitchViolation = 1.1;
constexpr double kArmijo = 1e-4;
constexpr double kStepMin = 2e-3;
constexpr int kStallsMax = 12;
constexpr std::size_t kFilterSize = 256;

}  // namespace

/// What a line search compares trial points with.
struct ChainSolver::Search {
  double violation = 0.0;
  double merit = 0.0;
  double merit_slope = 0.0;
  /// Should the merit decrease by Armijo's rule at this step?
  [[nodiscard]] bool by_merit(double step, double violation_min) const {
    return violation <= violation_min && merit_slope < 0.0 &&
           step * std::pow(-merit_slope, kSwitchMerit) > std::pow(violation, kSwitchViolation);
  }
};

ChainSolver::ChainSolver(const DecisionLayout& layout)
    : layout_(layout),
      terms_(layout.steps()),
      kkt_(layout_),
      slots_(layout_.slots()),
      filter_(kFilterSize) {
  for (Eigen::VectorXd* each : {&point_, &gradient_, &direction_, &trial_point_}) {
    each->setZero(layout_.variables() + 1);
  }
  for (Eigen::VectorXd* each : {&values_, &residual_, &slopes_, &slot_direction_, &slack_change_,
                                &trial_values_, &corrected_residual_}) {
    each->setZero(layout_.slots());
  }
  for (Eigen::VectorXd* each : {&equality_dual_, &equalities_, &new_equality_dual_,
                                &trial_equalities_, &corrected_equalities_}) {
    each->setZero(layout_.equalities());
  }
}

ChainOutcome ChainSolver::solve(const ChainProblem& problem, const Eigen::VectorXd& start,
                                const SolveOptions& options) {
  const ChainOutcome first = solve_from(problem, start, kPush, options);
  if (first.status == SolveStatus::solved || first.violation > kSecondViolationMax) return first;
  ChainOutcome second = solve_from(problem, start, kSecondPush, options);
  second.iterations += first.iterations;
  return second;
}

ChainOutcome ChainSolver::solve_from(const ChainProblem& problem, const Eigen::VectorXd& start,
                                     double push, const SolveOptions& options) {
  point_.head(layout_.variables()) = start;
  slots_.set_bounds(problem.lower(), problem.upper());
  start_from(problem, push);
  slots_.start(values_, push, kBarrierStart);
  equality_dual_.setZero();
  barrier_ = kBarrierStart;
  return iterate(problem, options);
}

/// How close to the last solution a solve begins.
struct ChainSolver::Warmth {
  double push = 0.0;     ///< Of slacks into their bounds.
  double barrier = 0.0;  ///< First.
  double spread = 0.0;   ///< Of slack times multiplier about it.
};

ChainOutcome ChainSolver::restart(const ChainProblem& problem, const SolveOptions& options,
                                  const Warmth& warmth) {
  slots_.set_bounds(problem.lower(), problem.upper());
  start_from(problem, warmth.push);
  slots_.restart(values_, warmth.push, warmth.barrier, warmth.spread);
  barrier_ = warmth.barrier;
  return iterate(problem, options);
}

ChainOutcome ChainSolver::solve_near(const ChainProblem& problem, const ChainSolution& solution,
                                     const SolveOptions& options) {
  point_.head(layout_.variables()) = solution.x;
  slots_.recall(solution.slot_multipliers);
  equality_dual_ = solution.equality_multipliers;
  return restart(problem, options, {.push = 1e-2, .barrier = 1e-3, .spread = 1e3});
}

ChainOutcome ChainSolver::polish(const ChainProblem& problem, const SolveOptions& options) {
  return restart(problem, options, {.push = 1e-6, .barrier = 1e-5, .spread = 1e4});
}

/// Moves the point inside of its own bounds and evaluates it.
void ChainSolver::start_from(const ChainProblem& problem, double push) {
  for (int i = 0; i < layout_.variables(); ++i) {
    point_(i) = problem.is_fixed(i) ? problem.bounds().lower(i)
                                    : slots_.inside(layout_.variable(i), point_(i), push);
  }
  cost_ = problem.values(point_, values_, equalities_);
  filter_size_ = 0;
  regularisation_ = 0.0;
  stalls_ = 0;
}

int ChainSolver::tightest_slot() const {
  const DecisionLayout& decision = layout_.decision();
  const int landing_time = layout_.variable(decision.landing_step());
  const int flight_time =
      layout_.steps().landed() ? landing_time : layout_.variable(decision.flight_step());
  int tightest = 0;
  double most = 0.0;
  for (int i = 0; i < layout_.slots(); ++i) {
    const double resistance = std::abs(slots_.multiplier()(i));
    if (i == flight_time || i == landing_time || resistance <= most) continue;
    most = resistance;
    tightest = i;
  }
  return tightest;
}

void ChainSolver::update_residuals() {
  residual_ = values_ - slots_.slack();
}

double ChainSolver::stationarity(const ChainProblem& problem) {
  problem.expand(point_, slots_.multiplier(), equality_dual_, terms_);
  problem.gradient(terms_, slots_.multiplier(), equality_dual_, gradient_);
  double worst = 0.0;
  for (int i = 0; i < layout_.variables(); ++i) {
    if (problem.is_fixed(i)) gradient_(i) = 0.0;
    worst = std::max(worst, std::abs(gradient_(i)) * problem.sizes()(i));
  }
  const double sum = slots_.multiplier_sum() + equality_dual_.cwiseAbs().sum();
  const double mean = sum / (slots_.sides() + layout_.equalities());
  return worst * kMultiplierScale / std::max(kMultiplierScale, mean);
}

double ChainSolver::violation_sum() const {
  return equalities_.cwiseAbs().sum() + residual_.cwiseAbs().sum();
}

double ChainSolver::largest_violation(const ChainProblem& problem) const {
  double worst = equalities_.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < values_.size(); ++i) {
    worst = std::max({worst, problem.lower()(i) - values_(i), values_(i) - problem.upper()(i)});
  }
  return worst;
}

ChainOutcome ChainSolver::iterate(const ChainProblem& problem, const SolveOptions& options) {
  ChainOutcome outcome;
  outcome.status = SolveStatus::iteration_limit;
  update_residuals();
  violation_scale_ = std::max(1.0, violation_sum());
  const double barrier_end = kBarrierEnd * options.tolerance;
  for (;; ++outcome.iterations) {
    outcome.stationarity = stationarity(problem);
    const double violation =
        std::max(equalities_.cwiseAbs().maxCoeff(), residual_.cwiseAbs().maxCoeff());
    const double error = std::max(outcome.stationarity, violation);
    if (outcome.iterations >= options.iterations_min && error <= options.tolerance &&
        slots_.complementarity(0.0) <= kComplementarityEnd * barrier_end) {
      outcome.status = SolveStatus::solved;
      break;
    }
    if (outcome.iterations >= options.iterations_max) break;
    while (barrier_ > barrier_end &&
           std::max(error, slots_.complementarity(barrier_)) <= kBarrierShare * barrier_) {
      barrier_ = std::max(barrier_end,
                          std::min(kBarrierFactor * barrier_, std::pow(barrier_, kBarrierPower)));
      filter_size_ = 0;
    }
    if (!find_direction(problem) || !line_search(problem)) {
      outcome.status = SolveStatus::infeasible;
      break;
    }
  }
  outcome.violation = largest_violation(problem);
  outcome.cost = cost_ / ChainProblem::kCostScale;
  return outcome;
}

/// One Newton step for these residuals of equalities and slots. @return false for wrong inertia.
bool ChainSolver::newton(const ChainProblem& problem, const Eigen::VectorXd& equalities,
                         const Eigen::VectorXd& residual) {
  slots_.slopes(barrier_, residual, slopes_);
  const KktInput input{&terms_,     &slots_.weight(), &slopes_,
                       &equalities, curvature_,       regularisation_};
  if (!kkt_.solve(problem, input, direction_, new_equality_dual_)) return false;
  if (!direction_.allFinite()) return false;
  problem.slots_along(terms_, direction_, slot_direction_);
  slack_change_ = slot_direction_ + residual;
  return true;
}

/// Exact where the reduced Hessian is positive definite, else without its indefinite part.
bool ChainSolver::find_direction(const ChainProblem& problem) {
  curvature_ = 1.0;
  regularisation_ = 0.0;
  if (newton(problem, equalities_, residual_)) return true;
  curvature_ = 0.0;
  regularisation_ = kRegularisation;
  return newton(problem, equalities_, residual_);
}

bool ChainSolver::acceptable_to_filter(const FilterEntry& entry) const {
  if (!(entry.violation <= 1e4 * violation_scale_) || !std::isfinite(entry.merit)) return false;
  for (std::size_t i = 0; i < filter_size_; ++i) {
    if (entry.violation >= filter_[i].violation && entry.merit >= filter_[i].merit) return false;
  }
  return true;
}

/// Evaluates a trial point and compares it with the present one and with the filter.
bool ChainSolver::try_step(const ChainProblem& problem, const Search& search, double step) {
  trial_point_ = point_ + step * direction_;
  trial_cost_ = problem.values(trial_point_, trial_values_, trial_equalities_);
  double violation = trial_equalities_.cwiseAbs().sum();
  for (Eigen::Index i = 0; i < trial_values_.size(); ++i) {
    violation += std::abs(trial_values_(i) - slots_.slack()(i) - step * slack_change_(i));
  }
  const double merit = trial_cost_ + barrier_ * slots_.barrier_value(step, slack_change_);
  if (!acceptable_to_filter({violation, merit})) return false;
  const double rounding = 1e-13 * std::abs(search.merit);
  if (search.by_merit(step, 1e-4 * violation_scale_)) {
    return merit <= search.merit + kArmijo * step * search.merit_slope + rounding;
  }
  if (violation > (1.0 - kViolationGain) * search.violation &&
      merit > search.merit - kMeritGain * search.violation + rounding) {
    return false;
  }
  if (filter_size_ < filter_.size()) {
    filter_[filter_size_++] = {(1.0 - kViolationGain) * search.violation,
                               search.merit - kMeritGain * search.violation};
  }
  return true;
}

/// A full step that made the equalities worse gets a second-order correction.
bool ChainSolver::correct(const ChainProblem& problem, const Search& search, double step) {
  corrected_equalities_ = step * equalities_ + trial_equalities_;
  corrected_residual_ = step * residual_ + trial_values_ - slots_.slack() - step * slack_change_;
  if (!newton(problem, corrected_equalities_, corrected_residual_)) return false;
  limits_ = slots_.find_step(slack_change_, barrier_, std::max(kKeepMin, 1.0 - barrier_));
  return try_step(problem, search, limits_.primal);
}

bool ChainSolver::line_search(const ChainProblem& problem) {
  const double keep = std::max(kKeepMin, 1.0 - barrier_);
  limits_ = slots_.find_step(slack_change_, barrier_, keep);
  Search search;
  search.violation = violation_sum();
  search.merit = cost_ + barrier_ * slots_.barrier_value(0.0, slack_change_);
  const double cost_slope = gradient_.dot(direction_) - slots_.multiplier().dot(slot_direction_) +
                            equality_dual_.dot(equalities_);
  search.merit_slope = cost_slope - barrier_ * slots_.barrier_slope(slack_change_);
  double step = limits_.primal;
  for (bool first = true; step > kStepMin * limits_.primal; first = false, step *= 0.5) {
    if (try_step(problem, search, step)) {
      accept(problem, step);
      return true;
    }
    if (!first || trial_equalities_.cwiseAbs().sum() < equalities_.cwiseAbs().sum()) continue;
    if (correct(problem, search, step)) {
      accept(problem, limits_.primal);
      return true;
    }
    if (!newton(problem, equalities_, residual_)) return false;
    limits_ = slots_.find_step(slack_change_, barrier_, keep);
  }
  // No step is better by the filter: go for feasibility alone, a little.
  if (++stalls_ > kStallsMax) return false;
  filter_size_ = 0;
  accept(problem, std::min(limits_.primal, 0.1));
  return true;
}

void ChainSolver::accept(const ChainProblem& problem, double step) {
  point_ += step * direction_;
  equality_dual_ += limits_.dual * (new_equality_dual_ - equality_dual_);
  slots_.move(step, limits_.dual, slack_change_, barrier_);
  cost_ = problem.values(point_, values_, equalities_);
  update_residuals();
}

}  // namespace hopscotch::planner
