#pragma once

#include <array>
#include <cstddef>

#include "model/planar_dynamics.hpp"

namespace hopscotch::planner {

/// Loads of the sagittal chain with their derivatives in closed form: what `model::PlanarDynamics`
/// says about forces, written out once more for speed. A test proves that both agree. Pure;
/// allocation-free.

/// A motion of the links at one instant, with the sines and cosines of its pitches.
struct LinkMotion {
  model::LinkArray<double> pitch{};         ///< [rad]
  model::LinkArray<double> rate{};          ///< [rad/s]
  model::LinkArray<double> acceleration{};  ///< [rad/s^2]
  model::LinkArray<double> cosine{};
  model::LinkArray<double> sine{};

  /// Fills the sines and cosines.
  void turn();
};

/// Derivatives of one number with respect to the motion of the links.
struct LinkSlope {
  model::LinkArray<double> pitch{};
  model::LinkArray<double> rate{};
  model::LinkArray<double> acceleration{};
};

/// Forces conjugate to the pitches, gravity apart in flight [N·m].
struct LinkForces {
  model::LinkArray<double> value{};
  std::array<LinkSlope, model::kPlanarLinks> slope{};
};

/// Ground force on flat fixed feet [N].
struct GroundForce {
  model::PlanarVector<double> value{};
  LinkSlope slope_x;
  LinkSlope slope_z;
};

/// Factors of a weighted sum of all loads.
struct LoadWeights {
  model::LinkArray<double> force{};
  model::PlanarVector<double> ground{};
};

/// Second derivatives of a weighted sum of loads. Those by two accelerations and by rate and
/// acceleration are zero, those by two rates are diagonal.
struct LinkCurvature {
  using Table = std::array<model::LinkArray<double>, model::kPlanarLinks>;
  Table pitch{};               ///< By two pitches.
  Table pitch_rate{};          ///< By pitch (first index) and rate.
  Table pitch_acceleration{};  ///< By pitch (first index) and acceleration.
  model::LinkArray<double> rate{};
};

/// Flat fixed feet: forces of shank, thigh and trunk, with gravity; those of the foot stay zero.
void stance_forces(const model::PlanarDynamics& dynamics, const LinkMotion& motion,
                   LinkForces& forces, GroundForce& ground);
/// Free flight: forces of all four links about their common CoM.
void flight_forces(const model::PlanarDynamics& dynamics, const LinkMotion& motion,
                   LinkForces& forces);

/// Second derivatives of weights . loads.
void stance_curvature(const model::PlanarDynamics& dynamics, const LinkMotion& motion,
                      const LoadWeights& weights, LinkCurvature& curvature);
void flight_curvature(const model::PlanarDynamics& dynamics, const LinkMotion& motion,
                      const model::LinkArray<double>& weights, LinkCurvature& curvature);

}  // namespace hopscotch::planner
