#pragma once

#include <Eigen/Core>
#include <vector>

#include "planner/chain_kkt.hpp"
#include "planner/chain_slots.hpp"
#include "planner/solve_outcome.hpp"

namespace hopscotch::planner {

/// How the chain solver ended; the solution is in ChainSolver::x().
struct ChainOutcome {
  SolveStatus status = SolveStatus::failed;
  int iterations = 0;
  double violation = 0.0;     ///< Largest breach of rows and bounds.
  double cost = 0.0;          ///< Not scaled.
  double stationarity = 0.0;  ///< Scaled gradient of the Lagrangian that is left.
};

/// Point and multipliers of a solved jump: what another solve close by may start from.
struct ChainSolution {
  Eigen::VectorXd x;                 ///< Decision vector.
  Eigen::VectorXd slot_multipliers;  ///< In the order of ChainLayout, as the next.
  Eigen::VectorXd equality_multipliers;
};

/// Primal-dual interior-point method for one jump: Newton steps by `ChainKkt`, inertia correction,
/// filter line search with second-order correction. Stops on iterations, never on time: equal
/// inputs give equal outputs. Sized once; a solve does not allocate. The algorithm follows Waechter
/// and Biegler, On the implementation of an interior-point filter line-search algorithm (2006).
class ChainSolver {
 public:
  explicit ChainSolver(const DecisionLayout& layout);

  /// From a decision vector, e.g. `kinematic_guess`. Where that nearly succeeds, once more with
  /// slacks further from their bounds; `iterations` counts both.
  ChainOutcome solve(const ChainProblem& problem, const Eigen::VectorXd& start,
                     const SolveOptions& options);
  /// From a solution, which may be of another target.
  ChainOutcome solve_near(const ChainProblem& problem, const ChainSolution& solution,
                          const SolveOptions& options);
  /// From the end of the last solve, where the problem has hardly changed since.
  ChainOutcome polish(const ChainProblem& problem, const SolveOptions& options);

  /// Decision vector of the last solve.
  [[nodiscard]] auto x() const { return point_.head(layout_.variables()); }
  /// How the last solve ended, to start another from.
  [[nodiscard]] ChainSolution solution() const {
    return {x(), slots_.multiplier(), equality_dual_};
  }
  /// Values of the slots at x().
  [[nodiscard]] const Eigen::VectorXd& slot_values() const { return values_; }
  /// Multipliers of the last solve, in the order of ChainLayout.
  [[nodiscard]] const Eigen::VectorXd& slot_multipliers() const { return slots_.multiplier(); }
  /// The inequality with the largest multiplier at the end of the last solve: what resists most.
  /// Step lengths apart: the slowest landing is always the cheapest.
  [[nodiscard]] int tightest_slot() const;
  [[nodiscard]] const Eigen::VectorXd& equality_multipliers() const { return equality_dual_; }

 private:
  struct FilterEntry {
    double violation = 0.0;
    double merit = 0.0;
  };
  struct Search;

  ChainOutcome iterate(const ChainProblem& problem, const SolveOptions& options);
  ChainOutcome solve_from(const ChainProblem& problem, const Eigen::VectorXd& start, double push,
                          const SolveOptions& options);
  struct Warmth;
  ChainOutcome restart(const ChainProblem& problem, const SolveOptions& options,
                       const Warmth& warmth);
  void start_from(const ChainProblem& problem, double push);
  void update_residuals();
  [[nodiscard]] double stationarity(const ChainProblem& problem);
  [[nodiscard]] double violation_sum() const;
  [[nodiscard]] double largest_violation(const ChainProblem& problem) const;
  [[nodiscard]] bool find_direction(const ChainProblem& problem);
  [[nodiscard]] bool newton(const ChainProblem& problem, const Eigen::VectorXd& equalities,
                            const Eigen::VectorXd& residual);
  [[nodiscard]] bool line_search(const ChainProblem& problem);
  [[nodiscard]] bool try_step(const ChainProblem& problem, const Search& search, double step);
  [[nodiscard]] bool correct(const ChainProblem& problem, const Search& search, double step);
  void accept(const ChainProblem& problem, double step);
  [[nodiscard]] bool acceptable_to_filter(const FilterEntry& entry) const;

  ChainLayout layout_;
  ChainTerms terms_;
  ChainKkt kkt_;
  ChainSlots slots_;
  double barrier_ = 0.0;
  double regularisation_ = 0.0;
  double curvature_ = 1.0;
  double violation_scale_ = 1.0;
  double cost_ = 0.0;
  int stalls_ = 0;
  StepLimits limits_;
  std::vector<FilterEntry> filter_;
  std::size_t filter_size_ = 0;
  Eigen::VectorXd point_;
  Eigen::VectorXd equality_dual_;
  Eigen::VectorXd values_;  ///< Of the slots.
  Eigen::VectorXd equalities_;
  Eigen::VectorXd residual_;  ///< Slot values minus slacks.
  Eigen::VectorXd gradient_;  ///< Of the Lagrangian.
  Eigen::VectorXd slopes_;
  Eigen::VectorXd direction_;
  Eigen::VectorXd new_equality_dual_;
  Eigen::VectorXd slot_direction_;  ///< Change of the slot values.
  Eigen::VectorXd slack_change_;
  Eigen::VectorXd trial_point_;
  Eigen::VectorXd trial_values_;
  Eigen::VectorXd trial_equalities_;
  Eigen::VectorXd corrected_equalities_;
  Eigen::VectorXd corrected_residual_;
  double trial_cost_ = 0.0;
};

}  // namespace hopscotch::planner
