#pragma once

#include "control/qp_solver_riccati.hpp"

/// Internal to qp_solver: the iteration. docs/wrench_mpc.md, section 4.
namespace hopscotch::control::riccati {

/// One-sided rows of a step: upper sides of the lanes, lower sides of the lanes, tops of the feet.
inline constexpr int kRows = 18;
inline constexpr int kTop = 2 * kLanes;

using StateTable = double[kMaxSteps][kState];
using InputTable = double[kMaxSteps][kInputs];
using RowTable = double[kMaxSteps][kRows];

/// The cone, the cost and the iterate of a problem whose dynamics are in a Sweep. The cost is half
/// of the one in WrenchQp, so that no factor 2 appears in gradients.
class InteriorPoint {
 public:
  // The problem.
  Sweep sweep;
  alignas(16) StateTable target{};     ///< Of the state at the end of each step.
  alignas(16) InputTable reference{};  ///< Of the inputs.
  alignas(16) double input_weight[kInputs]{};
  alignas(16) double velocity_gain[kMaxSteps][kWrench]{};
  alignas(16) double x0[kState]{};
  alignas(16) double bound[kTop]{};  ///< Of a lane per newton of normal force, upper then lower; 0
                                     ///< if free.
  double top = 0.0;                  ///< Of a normal force [N].
  alignas(16) RowTable active{};     ///< 1 for a row that exists, else 0.

  // The iterate. Rows that do not exist have slack and multiplier 1 and never move.
  alignas(16) InputTable input{};
  alignas(16) StateTable error{};  ///< State at the end of each step minus its target.
  alignas(16) RowTable slack{};
  alignas(16) RowTable multiplier{};

  /// Completes the iterate from `input`, which must be strictly inside the cone.
  void roll_out() noexcept;

  /// Gradient of the state and input cost with respect to the inputs, for the present iterate.
  void cost_gradient(InputTable& gradient) noexcept;

  /// Largest gradient of the Lagrangian; `gradient` is that of the cost.
  [[nodiscard]] double lagrangian_gradient(const InputTable& gradient) const noexcept;

  struct Measure {
    double complementarity = 0.0;  ///< Sum of slack times multiplier.
    double cost = 0.0;
  };
  [[nodiscard]] Measure measure() const noexcept;

  /// One predictor-corrector step from an iterate with this complementarity.
  /// @return Length of the step, 0 to 1; NaN if the numbers broke down and the iterate is
  /// unchanged.
  double advance_iterate(double complementarity) noexcept;

 private:
  void eliminate_rows() noexcept;
  void solve_direction() noexcept;
  double predict(double complementarity) noexcept;
  void aim(double complementarity_per_row) noexcept;
  [[nodiscard]] double longest_step() const noexcept;
  void take(double length) noexcept;

  Direction direction_;
  alignas(16) RowTable slack_inverse_{};
  alignas(16) RowTable multiplier_inverse_{};
  alignas(16) RowTable weight_{};  ///< multiplier / slack
  alignas(16) RowTable slack_change_{};
  alignas(16) RowTable multiplier_change_{};
  alignas(16)
      RowTable aim_{};  ///< Multipliers that the present slacks would have at the aimed-at centre.
};

}  // namespace hopscotch::control::riccati
