#pragma once

#include <array>
#include <cstddef>

#include "model/planar_dynamics.hpp"
#include "planner/decision_layout.hpp"

namespace hopscotch::planner {

/// Derivatives by the pitches of the links -> derivatives by the coordinates (shank, knee, trunk
/// and, for Dof = 4, foot).
template <int Dof>
inline void fold(const model::LinkArray<double>& link, double* out) {
  out[kShankPitch] = link[model::kShank] + link[model::kThigh];
  out[kKneeAngle] = -link[model::kThigh];
  out[kTrunkPitch] = link[model::kTrunk];
  if constexpr (Dof == kFlightDof) out[kFootPitch] = link[model::kFoot];
}

/// The same for a table of second derivatives.
template <int Dof, std::size_t D = static_cast<std::size_t>(Dof)>
inline std::array<std::array<double, D>, D> folded_table(
    const std::array<model::LinkArray<double>, model::kPlanarLinks>& table) {
  std::array<std::array<double, D>, model::kPlanarLinks> half{};
  for (std::size_t i = 0; i < model::kPlanarLinks; ++i) fold<Dof>(table[i], half[i].data());
  std::array<std::array<double, D>, D> out{};
  for (std::size_t c = 0; c < D; ++c) {
    const model::LinkArray<double> column{half[0][c], half[1][c], half[2][c], half[3][c]};
    std::array<double, D> down{};
    fold<Dof>(column, down.data());
    for (std::size_t r = 0; r < D; ++r) out[r][c] = down[r];
  }
  return out;
}

}  // namespace hopscotch::planner
