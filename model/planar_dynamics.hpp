#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "model/gravity.hpp"
#include "model/planar_chain.hpp"

namespace hopscotch::model {

/// Links of the sagittal chain, ground to trunk: index order of every `LinkArray`.
inline constexpr std::size_t kFoot = 0;
inline constexpr std::size_t kShank = 1;
inline constexpr std::size_t kThigh = 2;
inline constexpr std::size_t kTrunk = 3;
inline constexpr std::size_t kPlanarLinks = 4;

/// One number per link: absolute pitches about +y (+ = nose down) [rad], their rates or
/// accelerations.
template <typename T>
using LinkArray = std::array<T, kPlanarLinks>;

/// A vector in the sagittal plane: x forward, z up.
template <typename T>
struct PlanarVector {
  T x;
  T z;
};

/// Sagittal joints; the two legs together.
template <typename T>
struct PlanarJoints {
  T hip;
  T knee;
  T ankle;
};

/// Joint angles, rates or accelerations of one leg from those of the links.
template <typename T>
[[nodiscard]] PlanarJoints<T> joints_from_links(const LinkArray<T>& link) {
  return {link[kThigh] - link[kTrunk], link[kShank] - link[kThigh], link[kFoot] - link[kShank]};
}

/// The same at the motors: the ankle motor sits on the thigh and turns with q_knee + q_ankle.
template <typename T>
[[nodiscard]] PlanarJoints<T> motor_rates_from_links(const LinkArray<T>& link) {
  return {link[kThigh] - link[kTrunk], link[kShank] - link[kThigh], link[kFoot] - link[kThigh]};
}

/// Motor torques (referred to the joint side of each reduction) from joint torques.
template <typename T>
[[nodiscard]] PlanarJoints<T> motor_torques_from_joints(const PlanarJoints<T>& tau) {
  return {tau.hip, tau.knee - tau.ankle, tau.ankle};
}

/// What a motion asks of joints and ground while both feet stand flat and fixed.
template <typename T>
struct StanceLoads {
  PlanarJoints<T> tau;    ///< Joint torques of both legs, with armature and damping [N·m].
  PlanarVector<T> force;  ///< Ground on both feet [N].
  T moment;               ///< Of that force about the ankle axis, about +y [N·m].
};

/// Exact dynamics of the sagittal chain foot-shank-thigh-trunk, both legs lumped: eq. (2) with the
/// foot fixed, and the correct form of eqs. (3)-(4) in flight. Written for any scalar `T` with
/// + - * and sin, cos found by argument-dependent look-up, so that the planner differentiates the
/// very equations that the tests check. Pure; allocation-free; real-time safe for T = double.
///
/// Notation: a vector (x, z) of a link is the complex number x + i z; a pitch a turns it by
/// exp(-i a). The CoM of link i is the sum over links j of e_ij exp(-i a_j), from which
///   H_jk(a) = Re[C_jk exp(i (a_j - a_k))],  C_jk = sum_i m_i conj(e_ij) e_ik.
/// In flight C is reduced by the motion of the common CoM: C_jk - M conj(e_j) e_k, M e_j = sum_i
/// m_i e_ij.
class PlanarDynamics {
 public:
  explicit PlanarDynamics(const PlanarChain& chain);

  [[nodiscard]] const PlanarChain& chain() const { return chain_; }

  /// Whole-body CoM from the ankle axis [m].
  template <typename T>
  [[nodiscard]] PlanarVector<T> com(const LinkArray<T>& a) const;
  /// Velocity of the whole-body CoM relative to the ankle axis [m/s].
  template <typename T>
  [[nodiscard]] PlanarVector<T> com_velocity(const LinkArray<T>& a, const LinkArray<T>& w) const;
  /// Angular momentum of the links about their common CoM, about +y [kg·m^2/s]. Rotors turn inside
  /// the links and their reflected inertia acts on joints only, so they are not part of it.
  template <typename T>
  [[nodiscard]] T centroidal_momentum(const LinkArray<T>& a, const LinkArray<T>& w) const;

  /// Inverse dynamics with flat fixed feet: pitch, rate and acceleration of the foot are taken as
  /// zero. Eq. (2), and the ground reaction by Newton and Euler in place of eq. (10c).
  template <typename T>
  [[nodiscard]] StanceLoads<T> stance_loads(const LinkArray<T>& a, const LinkArray<T>& w,
                                            const LinkArray<T>& acceleration) const;

  /// Joint torques of both legs in free flight [N·m]; the motion must conserve the centroidal
  /// angular momentum, else the difference is silently taken up by the foot.
  template <typename T>
  [[nodiscard]] PlanarJoints<T> flight_torques(const LinkArray<T>& a, const LinkArray<T>& w,
                                               const LinkArray<T>& acceleration) const;

  /// Rate of change of the centroidal angular momentum, about +y [N·m]; zero in free flight.
  template <typename T>
  [[nodiscard]] T momentum_rate(const LinkArray<T>& a, const LinkArray<T>& w,
                                const LinkArray<T>& acceleration) const;

  /// Where points of the leg are, from the ankle axis [m].
  template <typename T>
  [[nodiscard]] PlanarVector<T> knee(const LinkArray<T>& a) const {
    return turned(0.0, chain_.shank.length, a[kShank]);
  }
  template <typename T>
  [[nodiscard]] PlanarVector<T> toe(const LinkArray<T>& a) const {
    return turned(chain_.toe, -chain_.sole_height, a[kFoot]);
  }
  template <typename T>
  [[nodiscard]] PlanarVector<T> heel(const LinkArray<T>& a) const {
    return turned(-chain_.heel, -chain_.sole_height, a[kFoot]);
  }
  /// Trunk origin B from the ankle axis [m].
  template <typename T>
  [[nodiscard]] PlanarVector<T> trunk_origin(const LinkArray<T>& a) const;
  /// Velocity of B relative to the ankle axis [m/s].
  template <typename T>
  [[nodiscard]] PlanarVector<T> trunk_origin_velocity(const LinkArray<T>& a,
                                                      const LinkArray<T>& w) const;

  /// A vector of a link, turned by its pitch.
  template <typename T>
  [[nodiscard]] static PlanarVector<T> turned(double x, double z, const T& pitch) {
    using std::cos;
    using std::sin;
    const T c = cos(pitch);
    const T s = sin(pitch);
    return {x * c + z * s, z * c - x * s};
  }

  /// M e_j / M: share of link j in the position of the whole-body CoM, in link j's frame [m].
  [[nodiscard]] PlanarVector<double> com_share(std::size_t link) const { return com_share_[link]; }

  /// Real and imaginary parts of C.
  struct Coupling {
    std::array<std::array<double, kPlanarLinks>, kPlanarLinks> real{};
    std::array<std::array<double, kPlanarLinks>, kPlanarLinks> imaginary{};

    /// Adds inertia and centrifugal forces of the links from `first` on, conjugate to their
    /// pitches.
    template <typename T>
    void add_forces(std::size_t first, const LinkArray<T>& a, const LinkArray<T>& w,
                    const LinkArray<T>& acceleration, LinkArray<T>& force) const;
  };
  /// C with the ankle axis fixed.
  [[nodiscard]] const Coupling& pinned() const { return pinned_; }
  /// C about the common CoM.
  [[nodiscard]] const Coupling& free() const { return free_; }

 private:
  /// Joint torques from the forces conjugate to the pitches, with armature and damping.
  template <typename T>
  [[nodiscard]] PlanarJoints<T> joint_torques(const LinkArray<T>& force, const LinkArray<T>& w,
                                              const LinkArray<T>& acceleration) const;

  PlanarChain chain_;
  std::array<PlanarVector<double>, kPlanarLinks> com_share_{};
  Coupling pinned_;  ///< Ankle axis fixed.
  Coupling free_;    ///< About the common CoM.
};

template <typename T>
PlanarVector<T> PlanarDynamics::com(const LinkArray<T>& a) const {
  PlanarVector<T> sum = turned(com_share_[kFoot].x, com_share_[kFoot].z, a[kFoot]);
  for (std::size_t j = kShank; j < kPlanarLinks; ++j) {
    const PlanarVector<T> r = turned(com_share_[j].x, com_share_[j].z, a[j]);
    sum.x = sum.x + r.x;
    sum.z = sum.z + r.z;
  }
  return sum;
}

template <typename T>
PlanarVector<T> PlanarDynamics::com_velocity(const LinkArray<T>& a, const LinkArray<T>& w) const {
  PlanarVector<T> sum{T(0.0), T(0.0)};
  for (std::size_t j = kFoot; j < kPlanarLinks; ++j) {
    const PlanarVector<T> r = turned(com_share_[j].x, com_share_[j].z, a[j]);
    sum.x = sum.x + w[j] * r.z;
    sum.z = sum.z - w[j] * r.x;
  }
  return sum;
}

template <typename T>
T PlanarDynamics::centroidal_momentum(const LinkArray<T>& a, const LinkArray<T>& w) const {
  using std::cos;
  using std::sin;
  T sum = T(0.0);
  for (std::size_t j = 0; j < kPlanarLinks; ++j) {
    sum = sum + free_.real[j][j] * w[j];
    for (std::size_t k = j + 1; k < kPlanarLinks; ++k) {
      const T angle = a[j] - a[k];
      const T h = free_.real[j][k] * cos(angle) - free_.imaginary[j][k] * sin(angle);
      sum = sum + h * (w[j] + w[k]);
    }
  }
  return sum;
}

template <typename T>
void PlanarDynamics::Coupling::add_forces(std::size_t first, const LinkArray<T>& a,
                                          const LinkArray<T>& w, const LinkArray<T>& acceleration,
                                          LinkArray<T>& force) const {
  using std::cos;
  using std::sin;
  LinkArray<T> square;
  for (std::size_t j = first; j < kPlanarLinks; ++j) square[j] = w[j] * w[j];
  for (std::size_t j = first; j < kPlanarLinks; ++j) {
    force[j] = force[j] + real[j][j] * acceleration[j];
    for (std::size_t k = j + 1; k < kPlanarLinks; ++k) {
      const T angle = a[j] - a[k];
      const T c = cos(angle);
      const T s = sin(angle);
      const T inertia = real[j][k] * c - imaginary[j][k] * s;
      const T centrifugal = real[j][k] * s + imaginary[j][k] * c;
      force[j] = force[j] + inertia * acceleration[k] + centrifugal * square[k];
      force[k] = force[k] + inertia * acceleration[j] - centrifugal * square[j];
    }
  }
}

template <typename T>
PlanarJoints<T> PlanarDynamics::joint_torques(const LinkArray<T>& force, const LinkArray<T>& w,
                                              const LinkArray<T>& acceleration) const {
  const PlanarJoints<T> rate = joints_from_links(w);
  const PlanarJoints<T> motor_acceleration = motor_rates_from_links(acceleration);
  const T ankle_rotor = chain_.armature_ankle * motor_acceleration.ankle;
  const T hip = T(0.0) - force[kTrunk];
  const T knee = hip - force[kThigh];
  const T ankle = knee - force[kShank];
  return {hip + chain_.armature_hip * motor_acceleration.hip + chain_.damping_hip * rate.hip,
          knee + chain_.armature_knee * motor_acceleration.knee + ankle_rotor +
              chain_.damping_knee * rate.knee,
          ankle + ankle_rotor + chain_.damping_ankle * rate.ankle};
}

template <typename T>
StanceLoads<T> PlanarDynamics::stance_loads(const LinkArray<T>& a, const LinkArray<T>& w,
                                            const LinkArray<T>& acceleration) const {
  const double mass = chain_.total_mass();
  LinkArray<T> force{T(0.0), T(0.0), T(0.0), T(0.0)};
  PlanarVector<T> ground{T(0.0), T(mass * kGravity)};
  for (std::size_t j = kShank; j < kPlanarLinks; ++j) {
    const PlanarVector<T> r = turned(mass * com_share_[j].x, mass * com_share_[j].z, a[j]);
    const T square = w[j] * w[j];
    ground.x = ground.x + acceleration[j] * r.z - square * r.x;
    ground.z = ground.z - acceleration[j] * r.x - square * r.z;
    force[j] = (-kGravity) * r.x;
  }
  pinned_.add_forces(kShank, a, w, acceleration, force);
  const double foot_weight_moment = chain_.foot.com_x * chain_.foot.mass * kGravity;
  const T moment = force[kShank] + force[kThigh] + force[kTrunk] - T(foot_weight_moment);
  return {joint_torques(force, w, acceleration), ground, moment};
}

template <typename T>
PlanarJoints<T> PlanarDynamics::flight_torques(const LinkArray<T>& a, const LinkArray<T>& w,
                                               const LinkArray<T>& acceleration) const {
  LinkArray<T> force{T(0.0), T(0.0), T(0.0), T(0.0)};
  free_.add_forces(kFoot, a, w, acceleration, force);
  return joint_torques(force, w, acceleration);
}

template <typename T>
T PlanarDynamics::momentum_rate(const LinkArray<T>& a, const LinkArray<T>& w,
                                const LinkArray<T>& acceleration) const {
  LinkArray<T> force{T(0.0), T(0.0), T(0.0), T(0.0)};
  free_.add_forces(kFoot, a, w, acceleration, force);
  return force[kFoot] + force[kShank] + force[kThigh] + force[kTrunk];
}

template <typename T>
PlanarVector<T> PlanarDynamics::trunk_origin(const LinkArray<T>& a) const {
  const PlanarVector<T> shank = turned(0.0, chain_.shank.length, a[kShank]);
  const PlanarVector<T> thigh = turned(0.0, chain_.thigh.length, a[kThigh]);
  const PlanarVector<T> trunk = turned(chain_.trunk_x, chain_.trunk_z, a[kTrunk]);
  return {shank.x + thigh.x + trunk.x, shank.z + thigh.z + trunk.z};
}

template <typename T>
PlanarVector<T> PlanarDynamics::trunk_origin_velocity(const LinkArray<T>& a,
                                                      const LinkArray<T>& w) const {
  const PlanarVector<T> shank = turned(0.0, chain_.shank.length, a[kShank]);
  const PlanarVector<T> thigh = turned(0.0, chain_.thigh.length, a[kThigh]);
  const PlanarVector<T> trunk = turned(chain_.trunk_x, chain_.trunk_z, a[kTrunk]);
  return {w[kShank] * shank.z + w[kThigh] * thigh.z + w[kTrunk] * trunk.z,
          T(0.0) - (w[kShank] * shank.x + w[kThigh] * thigh.x + w[kTrunk] * trunk.x)};
}

}  // namespace hopscotch::model
