#pragma once

#include <Eigen/Core>
#include <vector>

#include "planner/chain_problem.hpp"
#include "planner/chain_quadratic.hpp"

namespace hopscotch::planner {

/// What is to be solved besides the derivatives of the problem.
struct KktInput {
  const ChainTerms* terms = nullptr;
  const Eigen::VectorXd* slot_weights = nullptr;  ///< Sigma: curvature by each slot, >= 0.
  const Eigen::VectorXd* slot_slopes = nullptr;   ///< Gradient by each slot.
  const Eigen::VectorXd* equalities = nullptr;    ///< Their values.
  double curvature = 1.0;       ///< Factor on the part of the Hessian that may be indefinite.
  double regularisation = 0.0;  ///< Curvature added to each variable over its size squared.
};

/// The Newton step of the chain: minimises the quadratic model
///   (g + J' slopes) dx + dx' (H + J' Sigma J + regularisation) dx / 2
/// subject to the linearised equalities, by one backward and one forward sweep over the knots
/// (Riccati recursion: landing, touchdown, flight, lift-off, takeoff; of a jump that is down the
/// first alone). Equalities are eliminated
/// exactly, so no multipliers are factorised, and the curvature by each remaining variable tells
/// whether the reduced Hessian is positive definite. Sized once; solving does not allocate.
class ChainKkt {
 public:
  explicit ChainKkt(const ChainLayout& layout);

  /// @param[out] direction dx, one zero appended, zero for fixed variables.
  /// @param[out] multipliers of the equalities after the step.
  /// @return false where the reduced Hessian is not positive definite (or a row is degenerate); the
  ///         outputs are then not touched.
  [[nodiscard]] bool solve(const ChainProblem& problem, const KktInput& input,
                           Eigen::VectorXd& direction, Eigen::VectorXd& multipliers);

 private:
  // Slots of a stage: y, v, u of its step, then extras that the phase carries along.
  static constexpr std::size_t kTakeoffSize = 12;  ///< Extras: u of the step before.
  static constexpr std::size_t kFlightSize = 18;   ///< Extras: dt^f, x, z, vx, vz, L.
  static constexpr std::size_t kLandingSize = 10;  ///< Extras: dt^l.
  static constexpr std::size_t kTouchdownSize = 16;

  struct TakeoffStage {
    Quadratic<kTakeoffSize> value;  ///< Of the knot after the step.
    StepSweep<3, kTakeoffSize> sweep;
    std::array<Affine<kTakeoffSize>, 3> control;
  };
  struct FlightStage {
    Quadratic<kFlightSize> value;
    StepSweep<4, kFlightSize> sweep;
    std::array<Affine<kFlightSize>, 4> control;
    std::array<std::size_t, 4> order{};  ///< Slots in the order of elimination.
    Equalities<1, kFlightSize> momentum;
    Quadratic<kFlightSize> step;  ///< Before elimination; of the last step and for multipliers.
  };
  struct LandingStage {
    Quadratic<kLandingSize> value;
    StepSweep<3, kLandingSize> sweep;
    std::array<Affine<kLandingSize>, 3> control;
  };

  [[nodiscard]] bool sweep_back(const ChainProblem& problem, const KktInput& input);
  [[nodiscard]] bool landing_back(const ChainProblem& problem, const KktInput& input,
                                  Quadratic<kLandingSize>& q);
  [[nodiscard]] bool touchdown_back(const ChainProblem& problem, const KktInput& input);
  [[nodiscard]] bool flight_back(const ChainProblem& problem, const KktInput& input);
  [[nodiscard]] bool liftoff_back(const ChainProblem& problem, const KktInput& input);
  [[nodiscard]] bool takeoff_back(const ChainProblem& problem, const KktInput& input);
  void end_landing(const StepPoint<kStanceDof>& point, double share, const double* gap,
                   Quadratic<kLandingSize>& q);
  [[nodiscard]] bool close_last_gap(Quadratic<kLandingSize>& q);
  void hand_to_touchdown(const Quadratic<kLandingSize>& q);
  void hand_to_flight(const TouchdownTerms& terms, const Quadratic<kTouchdownSize>& q,
                      const Eigen::VectorXd& equalities);
  [[nodiscard]] bool arrive(const std::array<double, kFlightSize>& momentum_row, double momentum,
                            Quadratic<kFlightSize>& q);
  [[nodiscard]] static bool keep_momentum(const std::array<double, kFlightSize>& momentum_row,
                                          double momentum, FlightStage& stage,
                                          Quadratic<kFlightSize>& q);
  [[nodiscard]] std::array<double, 4> momentum_multiplier(int k, const MomentumTerms& terms,
                                                          const std::array<double, kFlightSize>& z,
                                                          double& multiplier) const;
  [[nodiscard]] std::array<double, 4> arrival_multipliers(const std::array<double, kFlightSize>& z,
                                                          Eigen::VectorXd& multipliers) const;
  void takeoff_forward(Eigen::VectorXd& dx, Eigen::VectorXd& multipliers) const;
  void flight_forward(const ChainTerms& terms, Eigen::VectorXd& dx,
                      Eigen::VectorXd& multipliers) const;
  [[nodiscard]] std::array<double, kLandingSize> touchdown_forward(
      const ChainProblem& problem, Eigen::VectorXd& dx, Eigen::VectorXd& multipliers) const;
  void landing_forward(std::array<double, kLandingSize> start, Eigen::VectorXd& dx,
                       Eigen::VectorXd& multipliers) const;

  ChainLayout layout_;
  std::vector<TakeoffStage> takeoff_;
  std::vector<FlightStage> flight_;
  std::vector<LandingStage> landing_;
  // The second to last landing step solves for the gap of the last one.
  Equalities<3, kLandingSize> last_gap_;         ///< At the knot between both.
  Equalities<3, kLandingSize> last_gap_pulled_;  ///< At the knot before.
  std::array<std::size_t, 3> last_gap_pivots_{};
  Quadratic<kLandingSize> last_gap_step_;
  // Touchdown: y, v of the flight, rates after it, x, z, vx, vz, dt^f, dt^l.
  Quadratic<kTouchdownSize> touchdown_;
  Equalities<3, kTouchdownSize> touchdown_rows_;
  std::array<std::size_t, 3> touchdown_pivots_{};
  std::array<Affine<kTouchdownSize>, 3> after_;
  Affine<kTouchdownSize> landing_step_;
  Affine<kLandingSize> rest_step_;  ///< The landing step of a jump that is down.
  // The last flight step solves for momentum, the level foot and the place of the ankle.
  Equalities<4, kFlightSize> arrival_;         ///< At touchdown.
  Equalities<4, kFlightSize> arrival_pulled_;  ///< At the knot before.
  // Lift-off.
  Quadratic<kFlightSize> liftoff_;
  std::array<Affine<kFlightSize>, 5> liftoff_com_;
  Affine<kFlightSize> flight_step_;
};

}  // namespace hopscotch::planner
