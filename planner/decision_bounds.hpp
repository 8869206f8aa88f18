#pragma once

#include <Eigen/Core>

#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// Bounds of the decision variables: eqs. (9a)-(9b) where a limit is that of one coordinate, the
/// initial and final condition (9e)-(9f) as equal bounds, step lengths (11d) and (12b).
struct DecisionBounds {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};
[[nodiscard]] DecisionBounds decision_bounds(const PlanarModel& model, const PlanarTask& task,
                                             const DecisionLayout& layout);

/// Typical size of each variable, by which the solver divides it.
[[nodiscard]] Eigen::VectorXd decision_sizes(const DecisionLayout& layout);

}  // namespace hopscotch::planner
