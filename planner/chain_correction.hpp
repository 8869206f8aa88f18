#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "planner/chain_layout.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// What a solved jump misses between its knots, as constants for another solve of the same problem
/// (deferred correction): a step with constant acceleration is not quite what constant torques
/// make, and rows at mid-points and knots do not see what is between them.
struct ChainCorrection {
  std::vector<StepCorrection> steps;  ///< Of all phases, in order.
  /// Bounds for each row, in its units, that keep the motion next to it inside of the physical
  /// limits; they count where they are narrower than the row's own.
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;

  explicit ChainCorrection(const ChainLayout& layout);

  /// Corrects nothing any more.
  void clear();
  /// Bounds rows no more: what another jump close by may start from.
  void clear_bounds();
};

/// Dynamics between the knots and limits beyond it are good: an aim that leaves room below the
/// tolerance of the certificate.
inline constexpr double kDefectWanted = 7e-4;

/// The largest of what a motion misses.
struct MotionDefect {
  double dynamics = 0.0;  ///< Pitch [rad] or rate [of the largest motor speed] at a step's end.
  double limits = 0.0;    ///< Beyond a physical limit, in row units; terrain [0.1 m].

  [[nodiscard]] double worst() const { return std::max(dynamics, limits); }
};

/// A solution: its motion, told what it was solved with, and the values of its rows.
struct SolvedRows {
  const PlanarMotion& motion;
  const Eigen::VectorXd& values;  ///< In the order of ChainLayout's slots.
};

/// Integrates a solved motion with its torques held over each step, compares with the knots and the
/// physical limits, and updates `correction`, which the motion was solved with.
MotionDefect update_correction(const PlanarModel& model, const PlanarTask& task,
                               const ChainLayout& layout, const SolvedRows& solved,
                               ChainCorrection& correction);

/// Tells a motion what it was solved with.
void set_correction(const ChainCorrection& correction, PlanarMotion& motion);

}  // namespace hopscotch::planner
