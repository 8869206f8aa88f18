#pragma once

#include <array>

#include "planner/flight_phase.hpp"

namespace hopscotch::planner {

/// MomentumLaw with derivatives in closed form, by y and v of a flight knot; by L it is -1.
struct MomentumTerms {
  std::array<double, 8> slope{};
  std::array<std::array<double, 8>, 8> hessian{};  ///< Times the multiplier.
};
void expand_momentum(const model::PlanarDynamics& dynamics, const std::array<double, 8>& knot,
                     double multiplier, MomentumTerms& terms);

/// ClearanceLaw with derivatives in closed form, by its own variables.
struct ClearanceTerms {
  std::array<std::array<double, 9>, ClearanceLaw::kRowCount> slope{};
  std::array<std::array<double, 9>, 9> hessian{};  ///< Of multipliers . rows.
};
void expand_clearance(const ClearanceLaw& law, const std::array<double, 9>& x,
                      const std::array<double, ClearanceLaw::kRowCount>& multipliers,
                      ClearanceTerms& terms);

}  // namespace hopscotch::planner
