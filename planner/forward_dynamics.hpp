#pragma once

#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// Link accelerations that joint torques cause [rad/s^2]: with feet fixed on the ground, or in free
/// flight. Solves the inverse dynamics of `model::PlanarDynamics`, which is linear in them.
[[nodiscard]] model::LinkArray<double> stance_acceleration(const model::PlanarDynamics& dynamics,
                                                           const LinkState& links,
                                                           const model::PlanarJoints<double>& tau);
[[nodiscard]] model::LinkArray<double> flight_acceleration(const model::PlanarDynamics& dynamics,
                                                           const LinkState& links,
                                                           const model::PlanarJoints<double>& tau);

/// One explicit step of length `h` with given rates [rad/s] and accelerations [rad/s^2].
[[nodiscard]] LinkState advanced(const LinkState& from, const model::LinkArray<double>& rate,
                                 const model::LinkArray<double>& acceleration, double h);

/// State after `duration` with constant joint torques, by Runge-Kutta steps of at most 1 ms.
[[nodiscard]] LinkState integrate(const model::PlanarDynamics& dynamics, core::JumpPhase phase,
                                  const LinkState& from, const model::PlanarJoints<double>& tau,
                                  double duration);

}  // namespace hopscotch::planner
