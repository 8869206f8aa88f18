#pragma once

#include "planner/block_forms.hpp"
#include "planner/takeoff_phase.hpp"

namespace hopscotch::planner {

/// Whole-body CoM of the flight as variables: at lift-off, then a parabola. Eq. (3) in its exact
/// form; local variables in this order.
template <typename T>
struct Ballistic {
  T x;     ///< At lift-off [m].
  T z;     ///< At lift-off [m].
  T vx;    ///< At lift-off [m/s].
  T vz;    ///< At lift-off [m/s].
  T step;  ///< dt^f [s].

  /// At knot `k` after lift-off [m].
  [[nodiscard]] model::PlanarVector<T> com(double k) const {
    const T t = k * step;
    return {x + vx * t, z + vz * t - (0.5 * model::kGravity) * (t * t)};
  }
  /// At knot `k` [m/s].
  [[nodiscard]] model::PlanarVector<T> velocity(double k) const {
    return {vx, vz - (model::kGravity * k) * step};
  }
};

/// One step in the air: joint torques by the dynamics of the four links about their common CoM,
/// with the motor limits of eq. (9). No external force: |F_v| of eq. (11c) is zero.
struct FlightLaw {
  static constexpr int kRows = MotorRows::kRows;
  model::PlanarDynamics dynamics;
  MotorRows motors;
  StepObjective objective;

  template <typename T>
  T operator()(const std::array<T, 13>& x, std::array<T, kRows>& rows) const {
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], x[3]);
    const model::LinkArray<T> w = links_from_coordinates(x[4], x[5], x[6], x[7]);
    const model::LinkArray<T> u = links_from_coordinates(x[8], x[9], x[10], x[11]);
    const model::PlanarJoints<T> tau = dynamics.flight_torques(a, w, u);
    motors.write(tau, w, half_change(u, x[12]), rows.data());
    return objective(a, w, u, tau);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    motors.bounds(lower, upper);
  }
};

/// The flight starts with the CoM, its velocity and the angular momentum of the last takeoff knot.
/// Variables: y, v of that knot, then x, z, vx, vz and L of the flight.
struct LiftoffLaw {
  static constexpr int kRows = 5;
  model::PlanarDynamics dynamics;
  model::PlanarVector<double> ankle{};  ///< In S [m].

  template <typename T>
  T operator()(const std::array<T, 11>& x, std::array<T, kRows>& rows) const {
    const T zero = T(0.0);
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], zero);
    const model::LinkArray<T> w = links_from_coordinates(x[3], x[4], x[5], zero);
    const model::PlanarVector<T> com = dynamics.com(a);
    const model::PlanarVector<T> velocity = dynamics.com_velocity(a, w);
    rows[0] = x[6] - com.x;
    rows[1] = x[7] - com.z;
    rows[2] = x[8] - velocity.x;
    rows[3] = x[9] - velocity.z;
    rows[4] = x[10] - dynamics.centroidal_momentum(a, w);
    return zero;
  }
  /// The CoM rows count from the ankle axis.
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, 0.0);
    lower[0] = ankle.x;
    lower[1] = ankle.z;
    std::copy_n(lower.begin(), kRows, upper.begin());
  }
};

/// Eq. (4) in its exact form: the centroidal angular momentum of the four links keeps its lift-off
/// value. Variables: y, v of a flight knot and L.
struct MomentumLaw {
  static constexpr int kRows = 1;
  model::PlanarDynamics dynamics;

  template <typename T>
  T operator()(const std::array<T, 9>& x, std::array<T, kRows>& rows) const {
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], x[3]);
    const model::LinkArray<T> w = links_from_coordinates(x[4], x[5], x[6], x[7]);
    rows[0] = dynamics.centroidal_momentum(a, w) - x[8];
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const { lower[0] = upper[0] = 0.0; }
  /// Linear in the rates and in L.
  static bool curved(int i, int j) { return i != 8 && j != 8 && !(i >= 4 && j >= 4); }
};

/// Eq. (11b): toe, heel and shank stay above the terrain. Variables: y of a flight knot, then the
/// five of `Ballistic`.
struct ClearanceLaw {
  /// Points of the shank, as shares of it from the ankle; the last one is the knee.
  static constexpr std::array<double, 3> kShankShares{1.0 / 3.0, 2.0 / 3.0, 1.0};
  /// Rows of the foot: toe and heel. Those of the shank follow.
  static constexpr std::size_t kFootRows = 2;
  /// Shanks that pass an edge in flight stray so far from the plan: a certified one has that much
  /// room beside their radius [m].
  static constexpr double kShankAllowance = 8e-3;
  static constexpr std::size_t kRowCount = kFootRows + kShankShares.size();
  static constexpr int kRows = static_cast<int>(kRowCount);
  model::PlanarDynamics dynamics;
  SmoothTerrain terrain;
  double knot = 0.0;            ///< Number of this knot, 0 at lift-off.
  double foot_clearance = 0.0;  ///< [m]
  double knee_clearance = 0.0;  ///< Of the shank's axis [m].

  /// The points that the rows are about, from the ankle axis [m].
  template <typename T>
  static std::array<model::PlanarVector<T>, kRowCount> points(const model::PlanarDynamics& dynamics,
                                                              const model::LinkArray<T>& a) {
    std::array<model::PlanarVector<T>, kRowCount> out{dynamics.toe(a), dynamics.heel(a)};
    const model::PlanarVector<T> knee = dynamics.knee(a);
    for (std::size_t i = 0; i < kShankShares.size(); ++i) {
      out[kFootRows + i] = {kShankShares[i] * knee.x, kShankShares[i] * knee.z};
    }
    return out;
  }

  template <typename T>
  T operator()(const std::array<T, 9>& x, std::array<T, kRows>& rows) const {
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], x[3]);
    const Ballistic<T> flight{x[4], x[5], x[6], x[7], x[8]};
    const model::PlanarVector<T> centre = flight.com(knot);
    const model::PlanarVector<T> from_ankle = dynamics.com(a);
    const model::PlanarVector<T> ankle{centre.x - from_ankle.x, centre.z - from_ankle.z};
    const std::array<model::PlanarVector<T>, kRowCount> point = points(dynamics, a);
    for (std::size_t r = 0; r < kRowCount; ++r) {
      rows[r] = ankle.z + point[r].z - terrain.height(ankle.x + point[r].x - look_back(r));
    }
    return T(0.0);
  }
  /// How far behind the point of a row its terrain is taken [m]. An edge lies anywhere around the
  /// sample that tells of it: toes meet it half a sample earlier, heels leave it half a sample
  /// later. Shanks follow over an edge that both have left behind.
  static constexpr double look_back(std::size_t row) {
    constexpr double kHalfSample = 0.5 * core::TerrainProfile::kStep;
    if (row == 0) return -kHalfSample;
    return row < kFootRows ? kHalfSample : SmoothTerrain::kEdgeDoubt;
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kFootRows, foot_clearance);
    std::fill_n(lower.begin() + kFootRows, kShankShares.size(), knee_clearance);
    std::fill_n(upper.begin(), kRows, kUnbounded);
  }
};

/// The laws of the flight and where they find their variables; `knot` counts from lift-off.
[[nodiscard]] FlightLaw flight_law(const PlanarModel& model, const PlanarTask& task);
[[nodiscard]] LiftoffLaw liftoff_law(const PlanarModel& model);
[[nodiscard]] ClearanceLaw clearance_law(const PlanarModel& model, const PlanarTask& task,
                                         int knot);
[[nodiscard]] std::array<int, 11> liftoff_variables(const DecisionLayout& layout);
[[nodiscard]] std::array<int, 9> clearance_variables(const DecisionLayout& layout, int knot);

/// Eq. (11): steps and knots of the flight, with lift-off; touchdown belongs to the landing.
void add_flight(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout,
                BlockList& blocks, StepCorrections corrections = {});

/// Clearance asked of toe and heel at share `s` of the flight: none at its ends, all in the middle
/// [m].
[[nodiscard]] double clearance_profile(double clearance, double s);

}  // namespace hopscotch::planner
