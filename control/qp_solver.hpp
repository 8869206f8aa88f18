#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "control/wrench_qp.hpp"
#include "core/robot_layout.hpp"

namespace hopscotch::control {

/// When the interior point stops.
struct QpTolerances {
  int iteration_cap = 0;      ///< Interior-point iterations, each of constant cost.
  double gap = 0.0;           ///< Sum of slack times multiplier over (1 + objective) [-].
  double stationarity = 0.0;  ///< Gradient of the Lagrangian over its scale [-].
};

enum class QpStatus : std::uint8_t {
  solved,
  iteration_limit,  ///< The solution is feasible, but not within the tolerances.
  infeasible,       ///< The cone of a foot in contact has no interior.
  bad_input,        ///< A number is not finite or out of its range; nothing was computed.
};

/// Multipliers of one foot's rows for the objective as WrenchQp writes it; 0 where a side is free.
struct ConeMultipliers {
  Eigen::Array4d upper = Eigen::Array4d::Zero();  ///< Of upper Fz - component >= 0.
  Eigen::Array4d lower = Eigen::Array4d::Zero();  ///< Of lower Fz + component >= 0.
  double top = 0.0;                               ///< Of max_normal_force - Fz >= 0.
};

/// For each step of the new QP the step of the previous one that its wrenches are taken from, or
/// -1 to start that step cold.
using WarmStartMap = std::array<int, WrenchQp::kMaxHorizon>;

/// Solves WrenchQp by a primal-feasible Mehrotra interior point whose Newton systems are reduced
/// by an information-form Riccati recursion on the 6-D wrench: constant cost per iteration, linear
/// in the horizon. Every iterate is strictly inside the cone and obeys the dynamics.
/// Real-time: no allocation, lock or exception after construction. Deterministic.
class QpSolver {
 public:
  explicit QpSolver(const QpTolerances& tolerances);
  ~QpSolver();
  QpSolver(QpSolver&&) noexcept;
  QpSolver& operator=(QpSolver&&) noexcept;

  [[nodiscard]] QpStatus solve_cold(const WrenchQp& qp) noexcept;
  /// Starts from the previous call's solution if that was `solved`, else cold.
  [[nodiscard]] QpStatus solve_warm(const WrenchQp& qp, const WarmStartMap& map) noexcept;

  /// Results of the last call that did not return bad_input or infeasible.
  [[nodiscard]] FootInput input(int step, core::Leg leg) const noexcept;
  [[nodiscard]] ConeMultipliers multipliers(int step, core::Leg leg) const noexcept;
  [[nodiscard]] BodyState state(int knot) const noexcept;  ///< knot 1 to horizon.
  [[nodiscard]] double objective() const noexcept;         ///< As WrenchQp writes it.
  [[nodiscard]] int iterations() const noexcept;
  [[nodiscard]] double gap() const noexcept;           ///< As in QpTolerances.
  [[nodiscard]] double stationarity() const noexcept;  ///< As in QpTolerances.
  [[nodiscard]] bool started_warm() const noexcept;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace hopscotch::control
