#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "control/qp_solver.hpp"
#include "control/wrench_qp.hpp"
#include "core/config_reader.hpp"
#include "core/contact_wrenches.hpp"
#include "core/control_reference.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// Tuning of WrenchMpc: section `control.wrench_mpc` of the configuration.
struct WrenchMpcConfig {
  int horizon = 0;  ///< Steps in the window, h in eq. (13); 1 to 20.
  StepRule rule = StepRule::zero_order_hold;
  BodyState state_weight = BodyState::Zero();   ///< diag(R0) over [p_WG, rpy, v_WG, w_WB].
  FootInput wrench_weight = FootInput::Zero();  ///< diag(R1) per foot over [Fx, Fy, My, Mz, Fz].
  double friction = 0.0;                        ///< mu in eq. (14b) [-]; 0 < mu <= 1.2.
  double cop_toe = 0.0;           ///< Centre of pressure at most so far ahead of the ankle [m].
  double cop_heel = 0.0;          ///< Centre of pressure at most so far behind the ankle [m].
  double yaw_moment_arm = 0.0;    ///< |Mz| <= this times Fz [m].
  double max_normal_force = 0.0;  ///< F_max in eq. (14c), per foot [N].
  QpTolerances tolerances;

  /// @throws core::ConfigError naming the key, its value and the violated rule.
  static WrenchMpcConfig load(const core::ConfigReader& section);
};

enum class MpcStatus : std::uint8_t { solved, iteration_limit, infeasible, bad_input };

/// What the QP is asked to do.
enum class MpcForm : std::uint8_t {
  error_state,  ///< Takeoff: corrects the plan's wrenches; no gravity, the cost is on u - u_plan.
  full,         ///< Landing and stand: eqs. (13)-(14), gravity in the dynamics, the cost is on u.
};

/// What the last solve cost and reached.
struct MpcStatistics {
  int iterations = 0;
  bool warm = false;          ///< Started from the previous solution.
  double gap = 0.0;           ///< Complementarity over (1 + objective) [-].
  double stationarity = 0.0;  ///< Largest gradient of the Lagrangian over the initial scale [-].
};

/// Chooses the ground wrench of each foot with one convex QP per call: the single rigid body of
/// eqs. (13)-(14), linearised about measurement (first step) and reference (the others), with the
/// plan's own step lengths. A foot in flight has zero wrench by construction: it has no columns.
/// Remembers its last solution to start the next one from. Derivation: docs/wrench_mpc.md.
class WrenchMpc {
 public:
  WrenchMpc(const WrenchMpcConfig& config, const model::RobotParameters& robot);
  ~WrenchMpc();
  WrenchMpc(WrenchMpc&&) noexcept;
  WrenchMpc& operator=(WrenchMpc&&) noexcept;

  /// @param state         At the moment of knot 0.
  /// @param reference     1 to `horizon` steps; `dt[k]` > 0 [s], phases may be mixed. The feet of
  ///                      step 0 are taken where `state` has them, with contact as in `reference`.
  /// @param[out] wrenches Ground on foot at the sole centre, in W [N, N·m]; written only when the
  ///                      result is `solved`, so the caller's last good value survives.
  /// @return bad_input if a number that matters is not finite, a step length is not positive or a
  ///         pitch is beyond what roll-pitch-yaw can express (1.4 rad); iteration_limit if the QP
  ///         did not converge. `infeasible` needs an empty cone, which the configuration excludes.
  /// Real-time: no allocation, lock or exception; the work is bounded by the iteration cap.
  [[nodiscard]] MpcStatus solve(const core::RobotState& state,
                                const core::ControlReference& reference, MpcForm form,
                                core::ContactWrenches& wrenches) noexcept;

  /// Of the last call that reached the QP.
  [[nodiscard]] const MpcStatistics& statistics() const noexcept;
  /// The last QP, where its warm start came from and its solution, for tests and benchmarks.
  [[nodiscard]] const WrenchQp& qp() const noexcept;
  [[nodiscard]] const WarmStartMap& warm_start_map() const noexcept;
  [[nodiscard]] const QpSolver& solver() const noexcept;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace hopscotch::control
