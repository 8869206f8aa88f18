#pragma once

#include <Eigen/Core>

#include "planner/decision_bounds.hpp"
#include "planner/nonlinear_program.hpp"
#include "planner/solve_outcome.hpp"

namespace hopscotch::planner {

/// Where the solver starts.
struct StartPoint {
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
