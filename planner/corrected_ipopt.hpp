#pragma once

#include <Eigen/Core>

#include "planner/corrected_solver.hpp"

namespace hopscotch::planner {

/// What CorrectedSolver does, by Ipopt on the blocks: solves a jump, looks what its motion misses
/// between the knots and solves again with that. The reference, in no hurry.
/// @param start Decision vector.
/// @return with the iterations of all solves.
[[nodiscard]] SolvedMotion solve_corrected_with_ipopt(const PlanarModel& model,
                                                      const PlanarTask& task,
                                                      const DecisionLayout& layout,
                                                      const Eigen::VectorXd& start);

}  // namespace hopscotch::planner
