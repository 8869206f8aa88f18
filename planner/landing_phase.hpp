#pragma once

#include "planner/flight_phase.hpp"

namespace hopscotch::planner {

/// Touchdown: the flat sole meets the target at a bounded speed; the ground's impulse leaves the
/// velocity of the CoM and the trunk's rate unchanged and stops the foot, which fixes the rates of
/// the landing. The change of rates is paid for. Variables: y (shank, knee, trunk) of the last
/// flight knot, its v (4), the rates after touchdown (3), then the five of `Ballistic`.
struct TouchdownLaw {
  static constexpr int kRows = 7;
  model::PlanarDynamics dynamics;
  double knots = 0.0;                   ///< Steps of the flight.
  model::PlanarVector<double> ankle{};  ///< In S when the sole stands on the target [m].
  double speed_down = 0.0;              ///< Largest of the sole [m/s].
  double speed_along = 0.0;             ///< [m/s]
  double jump_cost = 0.0;               ///< [s^2/rad^2]
  double speed_down_min = 0.0;          ///< Smallest of the sole [m/s].

  template <typename T>
  T operator()(const std::array<T, 15>& x, std::array<T, kRows>& rows) const {
    const T zero = T(0.0);
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], zero);
    const model::LinkArray<T> before = links_from_coordinates(x[3], x[4], x[5], x[6]);
    const model::LinkArray<T> after = links_from_coordinates(x[7], x[8], x[9], zero);
    const Ballistic<T> flight{x[10], x[11], x[12], x[13], x[14]};
    const model::PlanarVector<T> com = dynamics.com(a);
    const model::PlanarVector<T> centre = flight.com(knots);
    const model::PlanarVector<T> velocity = flight.velocity(knots);
    const model::PlanarVector<T> relative = dynamics.com_velocity(a, before);
    const model::PlanarVector<T> pinned = dynamics.com_velocity(a, after);
    rows[0] = centre.x - com.x;
    rows[1] = centre.z - com.z;
    rows[2] = velocity.x - pinned.x;
    rows[3] = velocity.z - pinned.z;
    rows[4] = x[9] - x[5];
    rows[5] = velocity.x - relative.x;
    rows[6] = velocity.z - relative.z;
    T cost = zero;
    for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
      const T change = after[j] - before[j];
      cost = cost + jump_cost * (change * change);
    }
    return cost;
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, 0.0);
    lower[0] = ankle.x;
    lower[1] = ankle.z;
    std::copy_n(lower.begin(), kRows, upper.begin());
    lower[5] = -speed_along;
    upper[5] = speed_along;
    lower[6] = -speed_down;
    upper[6] = -speed_down_min;
  }
};

/// `shank_range` where the jump ends.
[[nodiscard]] ShankRange landed_shank_range(const PlanarModel& model, const PlanarTask& task);

/// The laws of the landing and where touchdown finds its variables.
[[nodiscard]] StanceLaw landing_law(const PlanarModel& model, const PlanarTask& task, int k);
[[nodiscard]] TouchdownLaw touchdown_law(const PlanarModel& model, const PlanarTask& task);
[[nodiscard]] std::array<int, 15> touchdown_variables(const DecisionLayout& layout);

/// Eq. (12): touchdown and the way to rest, by the same exact chain as the takeoff in place of the
/// single rigid body of eqs. (5)-(6).
void add_landing(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout,
                 BlockList& blocks, StepCorrections corrections = {});

}  // namespace hopscotch::planner
