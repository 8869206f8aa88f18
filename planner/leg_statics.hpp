#pragma once

#include "model/planar_dynamics.hpp"

namespace hopscotch::planner {

/// Joint torques that hold a force on massless legs: tau = -J^T [F; M] with the Jacobian of the
/// foot, eq. (10c) with its sign corrected. Two legs together.
/// @param force Ground on the feet at the ankle axis [N]. @param moment About it [N·m].
template <typename T>
[[nodiscard]] model::PlanarJoints<T> static_torques(const model::PlanarChain& chain,
                                                    const model::LinkArray<T>& a,
                                                    const model::PlanarVector<T>& force,
                                                    const T& moment) {
  using model::PlanarDynamics;
  const model::PlanarVector<T> shank =
      PlanarDynamics::turned(0.0, chain.shank.length, a[model::kShank]);
  const model::PlanarVector<T> thigh =
      PlanarDynamics::turned(0.0, chain.thigh.length, a[model::kThigh]);
  const T knee = shank.z * force.x - shank.x * force.z - moment;
  return {knee + thigh.z * force.x - thigh.x * force.z, knee, -1.0 * moment};
}

/// CoM of the trunk link from the ankle axis [m].
template <typename T>
[[nodiscard]] model::PlanarVector<T> trunk_com(const model::PlanarChain& chain,
                                               const model::LinkArray<T>& a) {
  using model::PlanarDynamics;
  const model::PlanarVector<T> shank =
      PlanarDynamics::turned(0.0, chain.shank.length, a[model::kShank]);
  const model::PlanarVector<T> thigh =
      PlanarDynamics::turned(0.0, chain.thigh.length, a[model::kThigh]);
  const model::PlanarVector<T> trunk =
      PlanarDynamics::turned(chain.trunk.com_x, chain.trunk.com_z, a[model::kTrunk]);
  return {shank.x + thigh.x + trunk.x, shank.z + thigh.z + trunk.z};
}

/// Its velocity relative to the ankle axis [m/s].
template <typename T>
[[nodiscard]] model::PlanarVector<T> trunk_com_velocity(const model::PlanarChain& chain,
                                                        const model::LinkArray<T>& a,
                                                        const model::LinkArray<T>& w) {
  using model::PlanarDynamics;
  const model::PlanarVector<T> shank =
      PlanarDynamics::turned(0.0, chain.shank.length, a[model::kShank]);
  const model::PlanarVector<T> thigh =
      PlanarDynamics::turned(0.0, chain.thigh.length, a[model::kThigh]);
  const model::PlanarVector<T> trunk =
      PlanarDynamics::turned(chain.trunk.com_x, chain.trunk.com_z, a[model::kTrunk]);
  return {w[model::kShank] * shank.z + w[model::kThigh] * thigh.z + w[model::kTrunk] * trunk.z,
          -1.0 * (w[model::kShank] * shank.x + w[model::kThigh] * thigh.x +
                  w[model::kTrunk] * trunk.x)};
}

}  // namespace hopscotch::planner
