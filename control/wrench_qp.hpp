#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>

#include "core/robot_layout.hpp"

namespace hopscotch::control {

/// Wrench of the ground on one foot with the components that the optimisation may choose, in the
/// foot's own frames: [Fx, Fy, My, Mz, Fz] [N, N·m]. The moment about the toe axis, Mx, is zero by
/// construction, eq. (14d).
using FootInput = Eigen::Vector<double, 5>;

/// State of the single rigid body in the paper's order: [p_WG, rpy, v_WG, w_WB].
using BodyState = Eigen::Vector<double, 12>;

// Where in a FootInput a component stands. The first four are bounded by multiples of the last.
inline constexpr int kForceX = 0;
inline constexpr int kForceY = 1;
inline constexpr int kMomentY = 2;
inline constexpr int kMomentZ = 3;
inline constexpr int kForceZ = 4;

/// Contact wrench cone of one foot, eqs. (14b) to (14e): for each of the first four components
/// -lower Fz <= component <= upper Fz, and Fz <= max_normal_force. Infinity leaves a side free.
struct WrenchCone {
  static constexpr double kFree = std::numeric_limits<double>::infinity();
  Eigen::Array4d upper = Eigen::Array4d::Constant(kFree);  ///< Friction [-], lever arms [m].
  Eigen::Array4d lower = Eigen::Array4d::Constant(kFree);  ///< Friction [-], lever arms [m].
  double max_normal_force = 0.0;                           ///< [N]
};

/// One foot during one step.
struct WrenchQpFoot {
  bool contact = false;                                    ///< Without it the foot has no inputs.
  Eigen::Vector3d p_GF = Eigen::Vector3d::Zero();          ///< Foot from CoM, in W [m].
  Eigen::Matrix3d R_force = Eigen::Matrix3d::Identity();   ///< Frame of the force, to W.
  Eigen::Matrix3d R_moment = Eigen::Matrix3d::Identity();  ///< Frame of the moment, to W.
  FootInput reference = FootInput::Zero();  ///< What the wrench cost is measured from.
};

/// One step of the window, from knot k to knot k + 1.
struct WrenchQpStage {
  double dt = 0.0;                                                ///< [s]
  Eigen::Matrix3d rpy_rate = Eigen::Matrix3d::Identity();         ///< T: d(rpy)/dt = T w_WB.
  Eigen::Matrix3d inertia_inverse = Eigen::Matrix3d::Identity();  ///< In W [1/(kg·m^2)].
  /// What v_WG and w_WB gain during the step without any input, e.g. g dt [m/s, rad/s].
  Eigen::Vector<double, 6> velocity_gain = Eigen::Vector<double, 6>::Zero();
  BodyState target = BodyState::Zero();  ///< What x of knot k + 1 is to be.
  std::array<WrenchQpFoot, core::kLegs> feet{};
};

/// How position follows velocity within a step.
enum class StepRule : std::uint8_t {
  euler,            ///< q+ = q + dt T v, as the paper and the lab's code.
  zero_order_hold,  ///< q+ = q + dt T (v + v+) / 2: exact for constant wrenches and T.
};

/// The QP of eqs. (13)-(14) for one body that feet push, in physical terms:
///
///   min   sum_{k=1..h} |x_k - target_{k-1}|^2_state_weight
///       + sum_{k=0..h-1} sum_feet |u - reference|^2_input_weight            (no factor 1/2)
///   s.t.  v_{k+1} = v_k + velocity_gain_k + B_k u_k,   q_{k+1} by `rule`,   u in the cone.
///
/// u = 0 is always feasible. Derivation: docs/wrench_mpc.md.
struct WrenchQp {
  static constexpr int kMaxHorizon = 20;

  int horizon = 0;    ///< h, 1 to kMaxHorizon.
  double mass = 0.0;  ///< [kg]
  StepRule rule = StepRule::zero_order_hold;
  BodyState x0 = BodyState::Zero();            ///< State at knot 0.
  BodyState state_weight = BodyState::Zero();  ///< diag(R0) >= 0; > 0 for v and w.
  FootInput input_weight = FootInput::Zero();  ///< diag(R1) per foot, each >= kMinInputWeight.
  WrenchCone cone;
  std::array<WrenchQpStage, kMaxHorizon> stages{};

  /// Below this the problem is too badly conditioned for double precision.
  static constexpr double kMinInputWeight = 1e-7;
};

}  // namespace hopscotch::control
