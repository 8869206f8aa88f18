#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "planner/decision_layout.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// A StepCorrection in the coordinates of a step of `Dof` positions and rates: constants in its
/// equations.
template <int Dof>
struct StepShift {
  using Coordinates = std::array<double, static_cast<std::size_t>(Dof)>;
  Coordinates turn{};          ///< Of y1 beyond the trapezoid.
  Coordinates acceleration{};  ///< Of the law's acceleration beyond (v1 - v0) / h.
};

template <int Dof>
[[nodiscard]] StepShift<Dof> step_shift(const StepCorrection& correction) {
  const auto turn = coordinates_from_links(correction.turn);
  const auto acceleration = coordinates_from_links(correction.acceleration);
  StepShift<Dof> shift;
  std::copy_n(turn.begin(), shift.turn.size(), shift.turn.begin());
  std::copy_n(acceleration.begin(), shift.acceleration.size(), shift.acceleration.begin());
  return shift;
}

/// What a solved jump is corrected by, for each step of all phases in order; empty for nothing.
using StepCorrections = std::span<const StepCorrection>;

template <int Dof>
[[nodiscard]] StepShift<Dof> step_shift(StepCorrections corrections, int step) {
  if (corrections.empty()) return {};
  return step_shift<Dof>(corrections[static_cast<std::size_t>(step)]);
}

}  // namespace hopscotch::planner
