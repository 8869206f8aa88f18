#pragma once

#include <array>

#include "model/leg_mirror.hpp"
#include "model/robot_parameters.hpp"
#include "planner/differentiation.hpp"

namespace hopscotch::planner {

template <typename T>
using Vector3 = std::array<T, 3>;

template <typename T>
[[nodiscard]] Vector3<T> crossed(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// `v` turned by `angle` about a fixed unit axis (Rodrigues).
template <typename T>
[[nodiscard]] Vector3<T> turned_about(const Eigen::Vector3d& axis, const T& angle,
                                      const Vector3<T>& v) {
  using std::cos;
  using std::sin;
  const T c = cos(angle);
  const T s = sin(angle);
  const T along = (1.0 - c) * (axis.x() * v[0] + axis.y() * v[1] + axis.z() * v[2]);
  const Vector3<T> across{axis.y() * v[2] - axis.z() * v[1], axis.z() * v[0] - axis.x() * v[2],
                          axis.x() * v[1] - axis.y() * v[0]};
  Vector3<T> out;
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = c * v[i] + s * across[i] + axis[static_cast<Eigen::Index>(i)] * along;
  }
  return out;
}

/// From B into W, and back, with R_WB = Rz Ry Rx.
template <typename T>
[[nodiscard]] Vector3<T> into_world(const Vector3<T>& rpy, Vector3<T> v) {
  v = turned_about(Eigen::Vector3d::UnitX(), rpy[0], v);
  v = turned_about(Eigen::Vector3d::UnitY(), rpy[1], v);
  return turned_about(Eigen::Vector3d::UnitZ(), rpy[2], v);
}
template <typename T>
[[nodiscard]] Vector3<T> into_body(const Vector3<T>& rpy, Vector3<T> v) {
  v = turned_about(Eigen::Vector3d::UnitZ(), -1.0 * rpy[2], v);
  v = turned_about(Eigen::Vector3d::UnitY(), -1.0 * rpy[1], v);
  return turned_about(Eigen::Vector3d::UnitX(), -1.0 * rpy[0], v);
}

/// Kinematics and statics of one leg of five joints for any scalar.
struct LegChain {
  static constexpr std::size_t kJoints = static_cast<std::size_t>(core::kJointsPerLeg);
  std::array<Eigen::Vector3d, kJoints> axis;    ///< In the parent's frame.
  std::array<Eigen::Vector3d, kJoints> origin;  ///< In the parent's frame [m].
  Eigen::Vector3d sole;                         ///< Centre, in the foot's frame [m].

  LegChain(const model::RobotParameters& robot, core::Leg leg)
      : sole(model::sole_centre_in_foot(robot, leg)) {
    for (std::size_t i = 0; i < kJoints; ++i) {
      axis[i] = robot.joints[i].axis;
      origin[i] = model::joint_origin(robot, leg, static_cast<core::Joint>(i));
    }
  }

  /// Sole centre in B [m].
  template <typename T>
  [[nodiscard]] Vector3<T> sole_centre(const std::array<T, kJoints>& q) const {
    Vector3<T> p = constant<T>(sole);
    for (std::size_t i = kJoints; i-- > 0;) {
      p = turned_about(axis[i], q[i], p);
      for (std::size_t d = 0; d < 3; ++d) p[d] = p[d] + origin[i](static_cast<Eigen::Index>(d));
    }
    return p;
  }
  /// Direction of the toe in B.
  template <typename T>
  [[nodiscard]] Vector3<T> toe_direction(const std::array<T, kJoints>& q) const {
    Vector3<T> e = constant<T>(Eigen::Vector3d::UnitX());
    for (std::size_t i = kJoints; i-- > 0;) e = turned_about(axis[i], q[i], e);
    return e;
  }
  /// Joint torques that hold a force and a moment at the sole centre: tau = -J^T [f; m].
  /// @param force, moment Of the ground, in B [N, N·m].
  template <typename T>
  [[nodiscard]] std::array<T, kJoints> torques(const std::array<T, kJoints>& q, Vector3<T> force,
                                               Vector3<T> moment) const {
    std::array<Vector3<T>, kJoints> f;
    std::array<Vector3<T>, kJoints> m;
    for (std::size_t i = 0; i < kJoints; ++i) {  // down the leg, each in its joint's parent frame
      f[i] = force;
      m[i] = moment;
      force = turned_about(axis[i], -1.0 * q[i], force);
      moment = turned_about(axis[i], -1.0 * q[i], moment);
    }
    std::array<T, kJoints> tau;
    Vector3<T> r = constant<T>(sole);  // from the joint to the sole centre
    for (std::size_t i = kJoints; i-- > 0;) {
      r = turned_about(axis[i], q[i], r);
      const Vector3<T> turn = crossed(r, f[i]);
      tau[i] = T(0.0);
      for (std::size_t d = 0; d < 3; ++d) {
        tau[i] = tau[i] - axis[i](static_cast<Eigen::Index>(d)) * (turn[d] + m[i][d]);
      }
      for (std::size_t d = 0; d < 3; ++d) r[d] = r[d] + origin[i](static_cast<Eigen::Index>(d));
    }
    return tau;
  }

 private:
  template <typename T>
  [[nodiscard]] static Vector3<T> constant(const Eigen::Vector3d& v) {
    return {T(v.x()), T(v.y()), T(v.z())};
  }
};

}  // namespace hopscotch::planner
