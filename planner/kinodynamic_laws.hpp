#pragma once

#include "planner/leg_chain.hpp"
#include "planner/shared_limits.hpp"
#include "planner/smooth_terrain.hpp"

namespace hopscotch::planner {

/// The laws of the spatial kinodynamic formulation: one rigid body with the inertia of the standing
/// robot, moved by a force and a moment (about y and z) at the centre of each sole, with the
/// kinematics of both legs. A foot's effort is fx, fy, fz, my, mz in W.

/// p1 = p0 + h (v0 + v1) / 2. Variables: p0, p1, v0, v1, h.
struct MeanVelocityLaw {
  static constexpr int kRows = 1;
  template <typename T>
  T operator()(const std::array<T, 5>& x, std::array<T, kRows>& rows) const {
    rows[0] = x[1] - x[0] - 0.5 * (x[4] * (x[2] + x[3]));
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const { lower[0] = upper[0] = 0.0; }
};

/// v1 = v0 + h ((f_left + f_right) / m - g). Variables: v0, v1, both forces, h.
struct BodyForceLaw {
  static constexpr int kRows = 1;
  double mass = 0.0;
  double gravity = 0.0;  ///< Along this axis, downward [m/s^2].

  template <typename T>
  T operator()(const std::array<T, 5>& x, std::array<T, kRows>& rows) const {
    rows[0] = x[1] - x[0] - x[4] * ((x[2] + x[3]) * (1.0 / mass) - gravity);
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const { lower[0] = upper[0] = 0.0; }
};

/// Euler's equation with constant inertia. Variables: w0, w1, p, effort left, effort right, h.
struct BodyMomentLaw {
  static constexpr int kRows = 3;
  Eigen::Vector3d inertia;               ///< About the CoM, axes of W [kg·m^2].
  std::array<Eigen::Vector3d, 2> soles;  ///< In S [m].

  template <typename T>
  T operator()(const std::array<T, 20>& x, std::array<T, kRows>& rows) const {
    Vector3<T> moment{T(0.0), T(0.0), T(0.0)};
    for (std::size_t leg = 0; leg < 2; ++leg) {
      const std::size_t at = 9 + 5 * leg;
      const Vector3<T> lever{soles[leg].x() - x[6], soles[leg].y() - x[7], soles[leg].z() - x[8]};
      const Vector3<T> turn = crossed(lever, {x[at], x[at + 1], x[at + 2]});
      moment[0] = moment[0] + turn[0];
      moment[1] = moment[1] + turn[1] + x[at + 3];
      moment[2] = moment[2] + turn[2] + x[at + 4];
    }
    const Vector3<T> w{x[0], x[1], x[2]};
    const Vector3<T> spin{inertia.x() * w[0], inertia.y() * w[1], inertia.z() * w[2]};
    const Vector3<T> gyration = crossed(w, spin);
    for (std::size_t i = 0; i < 3; ++i) {
      const double by = 1.0 / inertia[static_cast<Eigen::Index>(i)];
      rows[i] = x[3 + i] - x[i] - x[19] * (by * (moment[i] - gyration[i]));
    }
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, 0.0);
    std::fill_n(upper.begin(), kRows, 0.0);
  }
};

/// Roll, pitch and yaw follow the angular velocity (R = Rz Ry Rx). Variables: rpy0, rpy1, w, h.
struct AttitudeLaw {
  static constexpr int kRows = 3;
  template <typename T>
  T operator()(const std::array<T, 10>& x, std::array<T, kRows>& rows) const {
    using std::cos;
    using std::sin;
    const T cy = cos(x[2]);
    const T sy = sin(x[2]);
    const T along = cy * x[6] + sy * x[7];  // rate about the heading, cos(pitch) times roll rate
    const T cp = cos(x[1]);
    const T h = x[9];
    rows[0] = cp * (x[3] - x[0]) - h * along;
    rows[1] = x[4] - x[1] - h * (cy * x[7] - sy * x[6]);
    rows[2] = x[5] - x[2] - h * x[8] - (x[3] - x[0]) * sin(x[1]);
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, 0.0);
    std::fill_n(upper.begin(), kRows, 0.0);
  }
};

/// Where a leg's sole is, and that it is level and straight. Variables: CoM, rpy, five joints.
struct SoleLaw {
  static constexpr int kRows = 5;
  LegChain leg;
  Eigen::Vector3d com_B;  ///< CoM in B, as if the legs did not move [m].
  Eigen::Vector3d sole;   ///< Where it stands, in S [m].
  SmoothTerrain terrain;
  double clearance = core::kNaN;  ///< In flight: above the terrain [m]; NaN while it stands.

  template <typename T>
  T operator()(const std::array<T, 11>& x, std::array<T, kRows>& rows) const {
    const Vector3<T> rpy{x[3], x[4], x[5]};
    const std::array<T, 5> q{x[6], x[7], x[8], x[9], x[10]};
    Vector3<T> place = leg.sole_centre(q);
    for (std::size_t i = 0; i < 3; ++i) {
      place[i] = place[i] - com_B(static_cast<Eigen::Index>(i));
    }
    place = into_world(rpy, place);
    const Vector3<T> toe = into_world(rpy, leg.toe_direction(q));
    rows[0] = toe[1];
    rows[1] = toe[2];
    rows[2] = x[1] + place[1];
    const T ahead = x[0] + place[0];
    const T above = x[2] + place[2];
    if (std::isnan(clearance)) {
      rows[3] = ahead;
      rows[4] = above;
    } else {
      rows[3] = above - terrain.height(ahead + 0.5 * kSoleLength);
      rows[4] = above - terrain.height(ahead - 0.5 * kSoleLength);
    }
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    lower[0] = lower[1] = 0.0;
    lower[2] = sole.y();
    lower[3] = std::isnan(clearance) ? sole.x() : clearance;
    lower[4] = std::isnan(clearance) ? sole.z() : clearance;
    std::copy_n(lower.begin(), kRows, upper.begin());
    if (!std::isnan(clearance)) upper[3] = upper[4] = kUnbounded;
  }
  static constexpr double kSoleLength = 0.145;  ///< Toe to heel [m].
};

/// What a standing foot may push, and the joint torques by tau = -J^T f. Variables: rpy, five
/// joints, effort.
struct FootEffortLaw {
  static constexpr int kRows = 5 + 8;
  LegChain leg;
  std::array<double, 5> torque_max{};  ///< [N·m]
  double friction = 0.0;
  double half_length = 0.0;   ///< Of the sole [m].
  double twist_radius = 0.0;  ///< Largest yaw moment per normal force [m].
  double weight = 0.0;        ///< [N]
  double torque_cost = 0.0;   ///< [1/(N·m)^2]

  template <typename T>
  T operator()(const std::array<T, 13>& x, std::array<T, kRows>& rows) const {
    const Vector3<T> rpy{x[0], x[1], x[2]};
    const std::array<T, 5> q{x[3], x[4], x[5], x[6], x[7]};
    const Vector3<T> force = into_body(rpy, Vector3<T>{x[8], x[9], x[10]});
    const Vector3<T> moment = into_body(rpy, Vector3<T>{T(0.0), x[11], x[12]});
    const std::array<T, 5> tau = leg.torques(q, force, moment);
    T cost = T(0.0);
    for (std::size_t i = 0; i < 5; ++i) {
      rows[i] = tau[i] * (1.0 / torque_max[i]);
      cost = cost + torque_cost * (tau[i] * tau[i]);
    }
    const double by = 1.0 / weight;
    const T normal = by * x[10];
    rows[5] = friction * normal - by * x[8];
    rows[6] = friction * normal + by * x[8];
    rows[7] = friction * normal - by * x[9];
    rows[8] = friction * normal + by * x[9];
    rows[9] = half_length * normal - by * x[11];
    rows[10] = half_length * normal + by * x[11];
    rows[11] = twist_radius * normal - by * x[12];
    rows[12] = twist_radius * normal + by * x[12];
    return cost;
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), 5, -1.0);
    std::fill_n(upper.begin(), 5, 1.0);
    std::fill_n(lower.begin() + 5, 8, 0.0);
    std::fill_n(upper.begin() + 5, 8, kUnbounded);
  }
};

/// A joint's speed between two knots, with its cost. Variables: q0, q1, h.
struct JointRateLaw {
  static constexpr int kRows = 2;
  double speed_max = 0.0;  ///< [rad/s]
  double posture = 0.0;    ///< Final angle [rad].
  double posture_cost = 0.0;
  double change_cost = 0.0;  ///< On the change over the step^2.

  template <typename T>
  T operator()(const std::array<T, 3>& x, std::array<T, kRows>& rows) const {
    const T change = x[1] - x[0];
    const T off = x[1] - posture;
    rows[0] = speed_max * x[2] - change;
    rows[1] = speed_max * x[2] + change;
    return change_cost * (change * change) + posture_cost * (off * off);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, 0.0);
    std::fill_n(upper.begin(), kRows, kUnbounded);
  }
};

/// Cost on the change of a force between steps. Variables: both.
struct ForceChangeLaw {
  static constexpr int kRows = 0;
  double cost = 0.0;
  template <typename T>
  T operator()(const std::array<T, 2>& x, std::array<T, 0>& /*rows*/) const {
    const T change = x[1] - x[0];
    return cost * (change * change);
  }
  void bounds(std::span<double> /*lower*/, std::span<double> /*upper*/) const {}
};

}  // namespace hopscotch::planner
