#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "planner/chain_layout.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// What a solved jump misses between its knots, as constants for another solve of the same problem
/// (deferred correction): a step with constant acceleration is not quite what constant torques
/// make, and rows at a step's mid-point do not see its ends.
struct ChainCorrection {
  std::vector<StepCorrection> steps;  ///< Of all phases, in order.
  Eigen::VectorXd tightening;         ///< Of each row's bounds, >= 0, in the row's units.

  explicit ChainCorrection(const ChainLayout& layout);
};

/// The largest of what a motion misses.
struct MotionDefect {
  double dynamics = 0.0;  ///< Pitch [rad] or rate [of the largest motor speed] at a step's end.
  double limits = 0.0;    ///< Beyond a physical limit, in row units.

  [[nodiscard]] double worst() const { return std::max(dynamics, limits); }
};

/// Integrates a solved motion with its torques held over each step, compares with the knots and the
/// physical limits, and adds what is missing to `correction`, which `motion` was solved with.
MotionDefect add_correction(const PlanarModel& model, const PlanarMotion& motion,
                            const ChainLayout& layout, ChainCorrection& correction);

/// Tells a motion what it was solved with.
void set_correction(const ChainCorrection& correction, PlanarMotion& motion);

}  // namespace hopscotch::planner
