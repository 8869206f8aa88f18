#pragma once

#include "planner/leg_statics.hpp"
#include "planner/planar_jump.hpp"
#include "planner/shared_limits.hpp"
#include "planner/smooth_terrain.hpp"

namespace hopscotch::planner {

/// The laws of the source's variable model as printed; readings where it is silent in
/// docs/decisions. Coordinates y are shank, knee and trunk, v their rates; the foot stays level.

/// One step of explicit Euler: q1 = q0 + dt v0. Variables: q0, v0, q1, dt.
struct EulerLaw {
  static constexpr int kRows = 1;
  template <typename T>
  T operator()(const std::array<T, 4>& x, std::array<T, kRows>& rows) const {
    rows[0] = x[2] - x[0] - x[3] * x[1];
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const { lower[0] = upper[0] = 0.0; }
};

/// Eq. (8) with weights on both legs together.
struct PaperCost {
  double posture = 0.1;  ///< Q0 [1/rad^2].
  double rate = 0.5;     ///< Q1 [s^2/rad^2].
  double torque = 0.01;  ///< Q2 [1/(N·m)^2].
  model::PlanarJoints<double> reference{};

  template <typename T>
  [[nodiscard]] T operator()(const model::LinkArray<T>& a, const model::LinkArray<T>& w,
                             const model::PlanarJoints<T>& tau) const {
    const model::PlanarJoints<T> q = model::joints_from_links(a);
    const model::PlanarJoints<T> dq = model::joints_from_links(w);
    const T hip = q.hip - reference.hip;
    const T knee = q.knee - reference.knee;
    const T ankle = q.ankle - reference.ankle;
    return posture * (hip * hip + knee * knee + ankle * ankle) +
           rate * (dq.hip * dq.hip + dq.knee * dq.knee + dq.ankle * dq.ankle) +
           torque * (tau.hip * tau.hip + tau.knee * tau.knee + tau.ankle * tau.ankle);
  }
};

/// What every phase knows of the robot.
struct PaperRobot {
  model::PlanarDynamics dynamics;
  MotorLimits limits;  ///< Of joints, without linkage and torque-speed line: eqs. (9c), (9d).
  GroundRows ground;   ///< Eqs. (9h)-(9j).
  PaperCost cost;

  static constexpr int kEffortRows = 6;
  /// Torques and motoring powers as shares of their limits.
  template <typename T>
  void write_efforts(const model::PlanarJoints<T>& tau, const model::LinkArray<T>& w,
                     T* rows) const {
    const model::PlanarJoints<T> dq = model::joints_from_links(w);
    rows[0] = tau.hip * (1.0 / limits.hip.torque);
    rows[1] = tau.knee * (1.0 / limits.knee.torque);
    rows[2] = tau.ankle * (1.0 / limits.ankle.torque);
    rows[3] = tau.hip * dq.hip * (1.0 / limits.hip.power);
    rows[4] = tau.knee * dq.knee * (1.0 / limits.knee.power);
    rows[5] = tau.ankle * dq.ankle * (1.0 / limits.ankle.power);
  }
  static void effort_bounds(std::span<double> lower, std::span<double> upper) {
    std::fill_n(lower.begin(), 3, -1.0);
    std::fill_n(lower.begin() + 3, 3, -kUnbounded);
    std::fill_n(upper.begin(), kEffortRows, 1.0);
  }
};

/// Eq. (10): the three-link pendulum, virtual ground force and moment by the contact Jacobian, and
/// the CoM over the feet. Variables: y, v, v of the next knot, F, M.
struct PaperTakeoffLaw {
  static constexpr int kRows = 3 + PaperRobot::kEffortRows + GroundRows::kRows + 1;
  PaperRobot robot;
  double step = 0.0;  ///< dt^t [s].

  template <typename T>
  T operator()(const std::array<T, 12>& x, std::array<T, kRows>& rows) const {
    const T zero = T(0.0);
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], zero);
    const model::LinkArray<T> w = links_from_coordinates(x[3], x[4], x[5], zero);
    const model::LinkArray<T> next = links_from_coordinates(x[6], x[7], x[8], zero);
    model::LinkArray<T> u{zero, zero, zero, zero};
    for (std::size_t j = 0; j < u.size(); ++j) u[j] = (next[j] - w[j]) * (1.0 / step);
    const model::PlanarJoints<T> tau = robot.dynamics.stance_loads(a, w, u).tau;
    const model::PlanarVector<T> force{x[9], x[10]};
    const model::PlanarJoints<T> held = static_torques(robot.dynamics.chain(), a, force, x[11]);
    rows[0] = (tau.hip - held.hip) * (1.0 / robot.limits.hip.torque);
    rows[1] = (tau.knee - held.knee) * (1.0 / robot.limits.knee.torque);
    rows[2] = (tau.ankle - held.ankle) * (1.0 / robot.limits.ankle.torque);
    robot.write_efforts(tau, w, rows.data() + 3);
    robot.ground.write(model::StanceLoads<T>{tau, force, x[11]}, rows.data() + 9);
    rows[14] = robot.dynamics.com(a).x * (1.0 / GroundRows::kFootLength);
    return robot.cost(a, w, tau);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), 3, 0.0);
    std::fill_n(upper.begin(), 3, 0.0);
    PaperRobot::effort_bounds(lower.subspan(3), upper.subspan(3));
    robot.ground.bounds(lower.subspan(9), upper.subspan(9));
    lower[14] = -robot.ground.heel / GroundRows::kFootLength;
    upper[14] = robot.ground.toe / GroundRows::kFootLength;
  }
};

/// Eqs. (3), (4), (11a): the trunk falls with the weight of the other links as an external force,
/// and a virtual foot force. Variables: y, v, the trunk CoM's velocity, then that and the trunk's
/// rate at the next knot, F_v, dt.
struct PaperFlightLaw {
  static constexpr int kRows = 3;
  PaperRobot robot;

  template <typename T>
  T operator()(const std::array<T, 14>& x, std::array<T, kRows>& rows) const {
    using model::PlanarDynamics;
    const model::PlanarChain& chain = robot.dynamics.chain();
    const T zero = T(0.0);
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], zero);
    const model::LinkArray<T> w = links_from_coordinates(x[3], x[4], x[5], zero);
    const model::PlanarVector<T> force{x[11], x[12]};
    const model::PlanarVector<T> trunk = trunk_com(chain, a);
    const model::PlanarVector<T> knee =
        PlanarDynamics::turned(0.0, chain.shank.length, a[model::kShank]);
    const T shank_x =
        PlanarDynamics::turned(chain.shank.com_x, chain.shank.com_z, a[model::kShank]).x;
    const T thigh_x =
        knee.x + PlanarDynamics::turned(chain.thigh.com_x, chain.thigh.com_z, a[model::kThigh]).x;
    const double below = chain.shank.mass + chain.thigh.mass + chain.foot.mass;
    T moment = trunk.x * force.z - trunk.z * force.x;
    moment = moment + model::kGravity * (chain.shank.mass * (shank_x - trunk.x) +
                                         chain.thigh.mass * (thigh_x - trunk.x) +
                                         chain.foot.mass * (chain.foot.com_x - trunk.x));
    const double mass = chain.trunk.mass;
    const T& dt = x[13];
    rows[0] = x[8] - x[6] - dt * (force.x * (1.0 / mass));
    rows[1] =
        x[9] - x[7] - dt * ((force.z - below * model::kGravity) * (1.0 / mass) - model::kGravity);
    rows[2] = x[10] - x[5] - dt * (moment * (1.0 / chain.trunk.inertia));
    return robot.cost(a, w, static_torques(chain, a, force, zero));
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, 0.0);
    std::fill_n(upper.begin(), kRows, 0.0);
  }
};

/// Eqs. (5), (6), (12a): one rigid body on the foot's force. Variables: y, v, the trunk CoM's
/// velocity, then that and the trunk's rate at the next knot, F, M, dt.
struct PaperLandingLaw {
  static constexpr int kDynamics = 3;
  static constexpr int kRows = kDynamics + PaperRobot::kEffortRows + GroundRows::kRows;
  PaperRobot robot;
  double inertia = 0.0;  ///< I_c: of all links about their CoM in the final posture [kg·m^2].

  template <typename T>
  T operator()(const std::array<T, 15>& x, std::array<T, kRows>& rows) const {
    const model::PlanarChain& chain = robot.dynamics.chain();
    const T zero = T(0.0);
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], zero);
    const model::LinkArray<T> w = links_from_coordinates(x[3], x[4], x[5], zero);
    const model::PlanarVector<T> force{x[11], x[12]};
    const model::PlanarVector<T> trunk = trunk_com(chain, a);
    const double mass = chain.total_mass();
    const T moment = trunk.x * force.z - trunk.z * force.x + x[13];
    const T& dt = x[14];
    rows[0] = x[8] - x[6] - dt * (force.x * (1.0 / mass));
    rows[1] = x[9] - x[7] - dt * (force.z * (1.0 / mass) - model::kGravity);
    rows[2] = x[10] - x[5] - dt * (moment * (1.0 / inertia));
    const model::PlanarJoints<T> tau = static_torques(chain, a, force, x[13]);
    robot.write_efforts(tau, w, rows.data() + kDynamics);
    robot.ground.write(model::StanceLoads<T>{tau, force, x[13]},
                       rows.data() + kDynamics + PaperRobot::kEffortRows);
    return robot.cost(a, w, tau);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kDynamics, 0.0);
    std::fill_n(upper.begin(), kDynamics, 0.0);
    PaperRobot::effort_bounds(lower.subspan(kDynamics), upper.subspan(kDynamics));
    robot.ground.bounds(lower.subspan(kDynamics + PaperRobot::kEffortRows),
                        upper.subspan(kDynamics + PaperRobot::kEffortRows));
  }
};

/// Eq. (9g), places: trunk CoM over a foot that stands. Variables: y, x, z of the trunk CoM.
struct TrunkPlaceLaw {
  static constexpr int kRows = 2;
  model::PlanarChain chain;
  model::PlanarVector<double> ankle{};

  template <typename T>
  T operator()(const std::array<T, 5>& x, std::array<T, kRows>& rows) const {
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], T(0.0));
    const model::PlanarVector<T> trunk = trunk_com(chain, a);
    rows[0] = x[3] - trunk.x;
    rows[1] = x[4] - trunk.z;
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    lower[0] = upper[0] = ankle.x;
    lower[1] = upper[1] = ankle.z;
  }
};

/// Eq. (9g), velocities. Variables: y, v, velocity of the trunk CoM.
struct TrunkVelocityLaw {
  static constexpr int kRows = 2;
  model::PlanarChain chain;

  template <typename T>
  T operator()(const std::array<T, 8>& x, std::array<T, kRows>& rows) const {
    const T zero = T(0.0);
    const model::PlanarVector<T> velocity =
        trunk_com_velocity(chain, links_from_coordinates(x[0], x[1], x[2], zero),
                           links_from_coordinates(x[3], x[4], x[5], zero));
    rows[0] = x[6] - velocity.x;
    rows[1] = x[7] - velocity.z;
    return zero;
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, 0.0);
    std::fill_n(upper.begin(), kRows, 0.0);
  }
};

/// Eq. (11b): toe and heel above the terrain. Variables: y, x, z of the trunk CoM.
struct PaperTerrainLaw {
  static constexpr int kRows = 2;
  model::PlanarDynamics dynamics;
  SmoothTerrain terrain;
  double clearance = 0.0;  ///< [m]

  template <typename T>
  T operator()(const std::array<T, 5>& x, std::array<T, kRows>& rows) const {
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], T(0.0));
    const model::PlanarVector<T> trunk = trunk_com(dynamics.chain(), a);
    std::size_t row = 0;
    for (const model::PlanarVector<T>& r : {dynamics.toe(a), dynamics.heel(a)}) {
      rows[row++] = x[4] - trunk.z + r.z - terrain.height(x[3] - trunk.x + r.x);
    }
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, clearance);
    std::fill_n(upper.begin(), kRows, kUnbounded);
  }
};

}  // namespace hopscotch::planner
