#pragma once

#include <cstddef>
#include <vector>

#include "apps/bench.hpp"
#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps {

struct BenchTarget {
  double distance = 0.0;
  double height = 0.0;
  planner::StartKind start = planner::StartKind::stand;
};

/// The published set of reachable targets, `<config>/bench/planner_targets.csv`; `planner_grid`
/// made it.
/// @throws core::ConfigError naming file and line.
[[nodiscard]] std::vector<BenchTarget> read_targets();

/// So many of the targets, spread evenly; all if they are fewer.
[[nodiscard]] std::vector<BenchTarget> spread(const std::vector<BenchTarget>& targets,
                                              std::size_t count);

/// The jump of a target over ground that changes height where `default_edge` says.
[[nodiscard]] planner::StepRequest step_of(const BenchTarget& target);
[[nodiscard]] planner::PlanRequest request_for(const BenchSetup& setup, const BenchTarget& target);

}  // namespace hopscotch::apps
