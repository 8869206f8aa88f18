#pragma once

#include <array>
#include <cstddef>

#include "planner/link_loads.hpp"
#include "planner/objective.hpp"
#include "planner/shared_limits.hpp"

namespace hopscotch::planner {

/// Derivatives of one step at its mid-point, with respect to (y, v, u, h): coordinates, rates and
/// accelerations of `Dof` coordinates and the step length.
template <int Dof>
struct StepTerms {
  static constexpr std::size_t kDof = static_cast<std::size_t>(Dof);
  static constexpr std::size_t kSize = 3 * kDof + 1;
  static constexpr std::size_t kRows =
      static_cast<std::size_t>(MotorRows::kRows + (Dof == kStanceDof ? GroundRows::kRows : 0));
  using Slope = std::array<double, kSize>;

  std::array<Slope, kRows> slope{};  ///< Of the rows.
  Slope gradient{};                  ///< Of the scaled cost.
  /// Second derivatives of scaled cost + multipliers . rows, symmetric, in two parts: `convex` (of
  /// the cost with loads that depend linearly on the motion, positive semidefinite) + `curvature`.
  std::array<Slope, kSize> convex{};
  std::array<Slope, kSize> curvature{};
};

/// StanceLaw (Dof = 3) or FlightLaw (Dof = 4) with derivatives in closed form: the motor rows, the
/// ground rows in stance, and the cost. Values come from the laws themselves.
template <int Dof>
class ChainStep {
 public:
  using Terms = StepTerms<Dof>;
  using Slope = typename Terms::Slope;
  using Multipliers = std::array<double, Terms::kRows>;

  /// @param ground Not used in flight.
  /// @param cost_scale Factor on the cost.
  ChainStep(const model::PlanarDynamics& dynamics, const MotorRows& motors,
            const GroundRows& ground, double cost_scale);

  /// @param middle (y, v, u, h) at the mid-point.
  void expand(const StepObjective& objective, const Slope& middle, const Multipliers& multipliers,
              Terms& terms) const;

 private:
  struct Loads;
  void find_loads(const Slope& middle, Loads& loads) const;
  void write_slopes(const Slope& middle, const Loads& loads, Terms& terms) const;
  void add_cost(const StepObjective& objective, const Slope& middle, const Loads& loads,
                Terms& terms) const;
  void add_row_curvature(const StepObjective& objective, const Loads& loads,
                         const Multipliers& multipliers, Terms& terms) const;
  void add_load_curvature(const Loads& loads, const std::array<double, 3>& weight,
                          const Multipliers& multipliers, Terms& terms) const;

  model::PlanarDynamics dynamics_;
  std::array<MotorLimit, 3> limits_;
  GroundRows ground_;
  double cost_scale_;
  std::array<Slope, 3> passive_{};  ///< Rotor inertia and damping in the motor torques.
};

}  // namespace hopscotch::planner
