#pragma once

#include <Eigen/Core>
#include <limits>
#include <string_view>

#include "planner/chain_correction.hpp"
#include "planner/chain_solver.hpp"
#include "planner/known_jump.hpp"
#include "planner/solve_outcome.hpp"

namespace hopscotch::planner {

/// A solution and its motion.
struct SolvedMotion {
  SolveOutcome outcome;
  PlanarMotion motion;
};

/// Rows and bounds may be missed by so much (shares of limits, metres, radians) before a solution
/// counts as none; the certificate then judges with the true limits.
[[nodiscard]] bool is_acceptable(const SolveOutcome& outcome);

/// The chain solver with deferred correction: solves a jump, looks what its motion misses between
/// the knots and solves again with that (docs/decisions/0071, 0073).
class CorrectedSolver {
 public:
  explicit CorrectedSolver(const DecisionLayout& layout);

  /// From a decision vector, e.g. `kinematic_guess`; `outcome.iterations` counts all solves.
  [[nodiscard]] SolvedMotion solve(const PlanarModel& model, const PlanarTask& task,
                                   const Eigen::VectorXd& start);
  /// From a known jump close by. Gives up early: a start that takes long was a bad one.
  [[nodiscard]] SolvedMotion solve_near(const PlanarModel& model, const PlanarTask& task,
                                        const KnownJump& neighbour);

  /// From now on a solve and its corrections take no more iterations than so. @pre positive
  void allow(int iterations) { allowed_ = iterations; }

  /// What `solved`, the answer of the last solve, leaves for others to start from.
  [[nodiscard]] KnownJump known(const PlanarTask& task, const SolvedMotion& solved) const;
  /// The limit with the largest multiplier at the end of the last solve, by name.
  [[nodiscard]] std::string_view obstacle() const { return obstacle_; }

 private:
  [[nodiscard]] SolvedMotion corrected(const PlanarModel& model, const PlanarTask& task,
                                       ChainProblem& problem, const ChainOutcome& solved);
  void refine(const PlanarModel& model, const PlanarTask& task, ChainProblem& problem,
              SolvedMotion& best);

  DecisionLayout layout_;
  ChainSolver chain_;
  ChainCorrection correction_;
  ChainCorrection last_correction_;  ///< That the motion at hand was solved with.
  ChainSolution best_;               ///< Of the last solve.
  std::string_view obstacle_;
  int allowed_ = std::numeric_limits<int>::max();
};

}  // namespace hopscotch::planner
