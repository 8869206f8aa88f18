#pragma once

#include <cstdint>

namespace hopscotch::planner {

enum class SolveStatus : std::uint8_t { solved, iteration_limit, infeasible, failed };

struct SolveOptions {
  int iterations_max = 0;
  double tolerance = 0.0;  ///< Of the scaled optimality conditions.
  int iterations_min = 0;  ///< So many are made even where the start is already good enough.
};

}  // namespace hopscotch::planner
