#pragma once

#include "control/wrench_qp.hpp"

/// Internal to qp_solver: the linear algebra of one Newton system. docs/wrench_mpc.md, section 3.
///
/// Plain arrays with fixed sizes, so that every loop has a constant length and stays in vector
/// registers. States are ordered [v w p rpy] here: velocities first, because they are what the
/// wrenches change. Matrices are stored as columns.
namespace hopscotch::control::riccati {

inline constexpr int kMaxSteps = WrenchQp::kMaxHorizon;
inline constexpr int kWrench = 6;   ///< Velocity increments of one step.
inline constexpr int kState = 12;   ///< [v w p rpy]
inline constexpr int kLanes = 8;    ///< Bounded components: 4 per foot, left first.
inline constexpr int kInputs = 10;  ///< The lanes, then the two normal forces.

using Square = double[kWrench][kWrench];
using Tall = double[kWrench][kState];

/// q += time v + rate w: how a part of a step moves the configuration.
struct Drift {
  double time = 0.0;    ///< [s]; 0: no motion.
  double rate[3][3]{};  ///< time * T, columns [s].
  /// Rows of `rate`, each behind three zeros.
  alignas(16) double padded[3][kWrench]{};
};

/// Dynamics of one step: drift, kick by the feet, drift.
struct Step {
  alignas(16) double columns[kInputs][kWrench]{};  ///< E: velocity increment per unit of input.
  alignas(16) double rows[kWrench][kInputs]{};     ///< E transposed.
  Drift before;
  Drift after;
  bool contact = false;  ///< Any foot.
};

/// Inverse of the inputs' own Hessian W (arrow-shaped per foot) in closed form:
/// W^-1 = diag(inverse of lanes) + arrow column * inverse of normal * arrow row.
struct Elimination {
  alignas(16) double inverse[kInputs]{};  ///< 0 for a foot without contact.
  alignas(16) double arrow[kLanes]{};  ///< Share of a lane per unit of normal force, sign turned.
};

/// Factors of one step, see kick_back().
struct Factor {
  alignas(16) Square c{};  ///< Unit lower: Pvv = C D C'.
  alignas(16) double d_inverse[kWrench]{};
  alignas(16) Square l{};  ///< Unit lower: D^-1 + C' S C = L G L'.
  alignas(16) double g_inverse[kWrench]{};
  alignas(16) Square bd{};        ///< Pqv C^-T D^-1.
  alignas(16) Tall z{};           ///< [C; BD] L^-T.
  alignas(16) Tall after_kick{};  ///< Columns of v of the cost-to-go before the kick: Z G^-1 Y'.
};

struct Sweep {
  int steps = 0;
  Step step[kMaxSteps];
  Elimination elimination[kMaxSteps];
  Factor factor[kMaxSteps];
  alignas(16) double state_weight[kState]{};
};

/// Right-hand side and answer of a Newton system.
struct Direction {
  alignas(16) double input_gradient[kMaxSteps][kInputs]{};
  alignas(16) double state_gradient[kMaxSteps][kState]{};  ///< At the end of each step.
  alignas(16) double input[kMaxSteps][kInputs]{};
  alignas(16) double state[kMaxSteps][kState]{};  ///< Change at the end of each step.
  alignas(16) double costate[kMaxSteps][kWrench]{};
  alignas(16) double eliminated[kMaxSteps][kInputs]{};  ///< W^-1 input_gradient.
};

/// Riccati recursion from the last step to the first.
void factorise(Sweep& sweep) noexcept;

/// Minimises the quadratic model; `factorise` comes first. The initial state does not change.
void solve(const Sweep& sweep, Direction& direction) noexcept;

/// Adjoint of the linear dynamics: gradient of the state cost with respect to each input.
void adjoint(const Sweep& sweep, const double (&state_gradient)[kMaxSteps][kState],
             double (&input_gradient)[kMaxSteps][kInputs]) noexcept;

/// Moves a state [v w p rpy] over one step: drift, add `kick` to the velocities, drift.
void advance(const Step& step, const double (&kick)[kWrench], double (&state)[kState]) noexcept;

/// E u, the velocity increment of a step's inputs.
void push(const Step& step, const double (&input)[kInputs], double (&kick)[kWrench]) noexcept;

}  // namespace hopscotch::control::riccati
