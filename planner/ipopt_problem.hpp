#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "planner/decision_bounds.hpp"
#include "planner/nonlinear_program.hpp"

namespace hopscotch::planner {

enum class SolveStatus : std::uint8_t { solved, iteration_limit, infeasible, failed };

/// Where the solver starts.
struct StartPoint {
  Eigen::VectorXd x;
};

struct SolveOptions {
  int iterations_max = 0;
  double tolerance = 0.0;  ///< Of the scaled optimality conditions.
};

struct SolveOutcome {
  SolveStatus status = SolveStatus::failed;
  int iterations = 0;
  double violation = 0.0;  ///< Largest breach of rows and bounds.
  double cost = 0.0;
  Eigen::VectorXd x;
};

/// Solves the program with Ipopt (interior point, exact derivatives, MUMPS). Stops on iterations,
/// never on time, so equal inputs give equal outputs. Writes nothing to the terminal.
/// @param sizes typical size of each variable; the solver works on x / sizes.
[[nodiscard]] SolveOutcome solve_with_ipopt(const NonlinearProgram& program,
                                            const DecisionBounds& bounds,
                                            const Eigen::VectorXd& sizes, const StartPoint& start,
                                            const SolveOptions& options);

}  // namespace hopscotch::planner
