#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace hopscotch::planner {

enum class SolveStatus : std::uint8_t { solved, iteration_limit, infeasible, failed };

struct SolveOptions {
  int iterations_max = 0;
  double tolerance = 0.0;  ///< Of the scaled optimality conditions.
  int iterations_min = 0;  ///< So many are made even where the start is already good enough.
};

struct SolveOutcome {
  SolveStatus status = SolveStatus::failed;
  int iterations = 0;
  double violation = 0.0;  ///< Largest breach of rows and bounds.
  double cost = 0.0;
  Eigen::VectorXd x;
};

}  // namespace hopscotch::planner
