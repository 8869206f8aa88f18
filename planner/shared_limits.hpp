#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "model/planar_dynamics.hpp"
#include "model/robot_parameters.hpp"
#include "planner/constraint_block.hpp"
#include "planner/planner_config.hpp"

namespace hopscotch::planner {

/// What the hip-pitch, knee and ankle motors of both legs together can give, referred to the joint
/// side of their reductions.
struct MotorLimit {
  double torque = 0.0;        ///< [N·m]
  double speed = 0.0;         ///< [rad/s]
  double corner_speed = 0.0;  ///< Full torque up to here, from there linearly to zero [rad/s].
  double power = 0.0;         ///< Motoring [W].
};
struct MotorLimits {
  MotorLimit hip;
  MotorLimit knee;
  MotorLimit ankle;
};
[[nodiscard]] MotorLimits motor_limits(const model::RobotParameters& robot,
                                       const Reserves& reserves);

/// Eqs. (9c)-(9d) and the torque-speed line, in motor space, for a step over which the torques are
/// held: per motor torque, line at both ends and power at the middle, as shares of their limits.
struct MotorRows {
  static constexpr int kPerMotor = 4;
  static constexpr int kRows = 3 * kPerMotor;
  MotorLimits limits;

  /// @param w      Link rates in the middle of the step [rad/s].
  /// @param change Their change over half of the step [rad/s].
  template <typename T>
  void write(const model::PlanarJoints<T>& tau, const model::LinkArray<T>& w,
             const model::LinkArray<T>& change, T* rows) const {
    const model::PlanarJoints<T> torque = model::motor_torques_from_joints(tau);
    const model::PlanarJoints<T> speed = model::motor_rates_from_links(w);
    const model::PlanarJoints<T> half = model::motor_rates_from_links(change);
    write_motor(limits.hip, torque.hip, speed.hip, half.hip, rows);
    write_motor(limits.knee, torque.knee, speed.knee, half.knee, rows + kPerMotor);
    write_motor(limits.ankle, torque.ankle, speed.ankle, half.ankle, rows + 2 * kPerMotor);
  }
  /// Power rows that torque limit and line already imply are left unbounded.
  void bounds(std::span<double> lower, std::span<double> upper) const;

 private:
  /// The line of both motoring quadrants is one two-sided row: where torque and speed have the
  /// same sign, |t + b w| <= 1 with t falling from full torque at the corner to 0 at top speed.
  template <typename T>
  static void write_motor(const MotorLimit& limit, const T& torque, const T& speed, const T& half,
                          T* rows) {
    rows[0] = torque * (1.0 / limit.torque);
    const T middle =
        rows[0] * ((limit.speed - limit.corner_speed) / limit.speed) + speed * (1.0 / limit.speed);
    rows[1] = middle - half * (1.0 / limit.speed);
    rows[2] = middle + half * (1.0 / limit.speed);
    rows[3] = torque * speed * (1.0 / limit.power);
  }
};

/// Of the friction, as a certified plan may use it at any instant. Between the knots the reserve
/// for feedback may shrink to this, or nothing is left to hold the landing with.
inline constexpr double kFrictionShareMax = 0.95;

/// Eqs. (9h)-(9j) with the ground reaction of Newton and Euler: normal force, friction and the line
/// foot in its physical sense, all divided by the robot's weight.
struct GroundRows {
  static constexpr int kRows = 5;
  static constexpr double kFootLength = 0.1;  ///< Brings the moment rows to the size of the others.
  double weight = 0.0;                        ///< M g [N].
  double friction = 0.0;                      ///< mu, with reserve.
  double normal_force_min = 0.0;              ///< [N]
  double normal_force_max = 0.0;              ///< [N]
  double toe = 0.0;          ///< Foremost centre of pressure ahead of the ankle axis [m].
  double heel = 0.0;         ///< Rearmost centre of pressure behind the ankle axis [m].
  double sole_height = 0.0;  ///< Ankle axis above the sole [m].

  template <typename T>
  void write(const model::StanceLoads<T>& loads, T* rows) const {
    const T fx = loads.force.x * (1.0 / weight);
    const T fz = loads.force.z * (1.0 / weight);
    // Moment of the ground force about the ankle axis: -h F_x - x_cop F_z.
    const T pressure = (loads.moment * (1.0 / weight) + sole_height * fx) * (1.0 / kFootLength);
    rows[0] = fz;
    rows[1] = friction * fz - fx;
    rows[2] = friction * fz + fx;
    rows[3] = (toe / kFootLength) * fz + pressure;
    rows[4] = (heel / kFootLength) * fz - pressure;
  }
  void bounds(std::span<double> lower, std::span<double> upper) const;
};
[[nodiscard]] GroundRows ground_rows(const model::PlanarChain& chain, const PlannerConfig& config,
                                     double cop_margin);

/// Eqs. (9a)-(9b) where they are no plain bounds of a coordinate: hip angle and hip and ankle motor
/// speed at a knot; in flight also the ankle angle. Linear.
template <int Dof>
struct JointRows {
  static constexpr int kRows = Dof;
  static constexpr std::size_t kRowCount = static_cast<std::size_t>(Dof);
  static constexpr std::size_t kVariables = 2 * kRowCount;
  double hip_lower = 0.0;    ///< [rad]
  double hip_upper = 0.0;    ///< [rad]
  double ankle_lower = 0.0;  ///< [rad]
  double ankle_upper = 0.0;  ///< [rad]
  double hip_speed = 0.0;    ///< [rad/s]
  double ankle_speed = 0.0;  ///< Of the ankle motor [rad/s].

  template <typename T>
  T operator()(const std::array<T, kVariables>& x, std::array<T, kRowCount>& rows) const {
    T foot = T(0.0);
    T foot_rate = T(0.0);
    if constexpr (Dof == kFlightDof) {
      foot = x[kFootPitch];
      foot_rate = x[kRowCount + kFootPitch];
    }
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], foot);
    const model::LinkArray<T> w =
        links_from_coordinates(x[kRowCount], x[kRowCount + 1], x[kRowCount + 2], foot_rate);
    const model::PlanarJoints<T> speed = model::motor_rates_from_links(w);
    rows[0] = model::joints_from_links(a).hip;
    rows[1] = speed.hip * (1.0 / hip_speed);
    rows[2] = speed.ankle * (1.0 / ankle_speed);
    if constexpr (Dof == kFlightDof) rows[3] = model::joints_from_links(a).ankle;
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    lower[0] = hip_lower;
    upper[0] = hip_upper;
    lower[1] = lower[2] = -1.0;
    upper[1] = upper[2] = 1.0;
    if constexpr (Dof == kFlightDof) {
      lower[3] = ankle_lower;
      upper[3] = ankle_upper;
    }
  }
  /// Angles do not depend on rates and the other way round.
  static bool depends(int row, int column) {
    const bool rate_row = row == 1 || row == 2;
    return rate_row == (column >= Dof);
  }
  static bool curved(int /*i*/, int /*j*/) { return false; }
};
template <int Dof>
[[nodiscard]] JointRows<Dof> joint_rows(const model::RobotParameters& robot,
                                        const PlannerConfig& config);

}  // namespace hopscotch::planner
