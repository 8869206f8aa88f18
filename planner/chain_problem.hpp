#pragma once

#include <Eigen/Core>
#include <vector>

#include "planner/chain_correction.hpp"
#include "planner/chain_knots.hpp"
#include "planner/chain_layout.hpp"
#include "planner/chain_place.hpp"
#include "planner/chain_step.hpp"
#include "planner/decision_bounds.hpp"
#include "planner/landing_phase.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

struct LiftoffTerms {
  std::array<std::array<double, 11>, LiftoffLaw::kRows> slope{};
  std::array<double, 121> hessian{};  ///< Lower triangle, row by row.
};
struct TouchdownTerms {
  std::array<std::array<double, 15>, TouchdownLaw::kRows> slope{};
  std::array<double, 15> gradient{};
  std::array<double, 225> hessian{};  ///< Of the rows; lower triangle, row by row.
};

/// All derivatives of a jump at one point.
struct ChainTerms {
  std::vector<StepExpansion<kStanceDof>> takeoff;
  std::vector<StepExpansion<kFlightDof>> flight;
  std::vector<StepExpansion<kStanceDof>> landing;
  std::vector<MomentumTerms> momentum;
  std::vector<ClearanceTerms> clearance;
  LiftoffTerms liftoff;
  TouchdownTerms touchdown;

  explicit ChainTerms(const StepCounts& steps);
};

/// The jump of `add_takeoff`, `add_flight` and `add_landing` in the form the chain solver wants:
/// the same rows, bounds and cost (times kCostScale), but step after step with fused derivatives. A
/// test proves that it equals the blocks. Points are decision vectors with one zero appended, which
/// is what kNoVariable refers to. Evaluation does not allocate.
class ChainProblem {
 public:
  static constexpr double kCostScale = 0.1;

  ChainProblem(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout);

  /// Solves are from now on for the problem with this correction; it replaces an earlier one.
  void correct(const ChainCorrection& correction);

  [[nodiscard]] const ChainLayout& layout() const { return layout_; }
  /// Bounds of the slots; +-kUnbounded where there is none.
  [[nodiscard]] const Eigen::VectorXd& lower() const { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const { return upper_; }
  [[nodiscard]] const DecisionBounds& bounds() const { return bounds_; }
  /// Typical size of each variable.
  [[nodiscard]] const Eigen::VectorXd& sizes() const { return sizes_; }
  [[nodiscard]] bool is_fixed(int variable) const {
    return bounds_.lower(variable) == bounds_.upper(variable);
  }

  /// @return the scaled cost; fills the values of slots and equalities (left side minus right).
  double values(const Eigen::VectorXd& point, Eigen::VectorXd& slots,
                Eigen::VectorXd& equalities) const;

  /// Derivatives; second ones of scaled cost + multipliers . slots + multipliers . equalities.
  void expand(const Eigen::VectorXd& point, const Eigen::VectorXd& slot_multipliers,
              const Eigen::VectorXd& equality_multipliers, ChainTerms& terms) const;

  /// Gradient of scaled cost + weights . slots + weights . equalities.
  void gradient(const ChainTerms& terms, const Eigen::VectorXd& slot_weights,
                const Eigen::VectorXd& equality_weights, Eigen::VectorXd& gradient) const;

  /// Change of the slots along a direction.
  void slots_along(const ChainTerms& terms, const Eigen::VectorXd& direction,
                   Eigen::VectorXd& slots) const;

  /// Weight of the change of acceleration between takeoff step `step` and the next, cost scale
  /// included.
  [[nodiscard]] double smoothness(int step) const {
    return smoothness_[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] const StepPlace<kStanceDof>& takeoff_place(int step) const {
    return takeoff_places_[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] const StepPlace<kFlightDof>& flight_place(int step) const {
    return flight_places_[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] const StepPlace<kStanceDof>& landing_place(int step) const {
    return landing_places_[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] const JointRows<kStanceDof>& stance_joints() const { return stance_joints_; }
  [[nodiscard]] const JointRows<kFlightDof>& flight_joints() const { return flight_joints_; }
  /// Variables of clearance row block `step` (of the knot after that step).
  [[nodiscard]] std::array<int, 9> clearance_place(int step) const {
    return clearance_variables(layout_.decision(), step + 1);
  }
  [[nodiscard]] const std::array<int, 15>& touchdown_place() const { return touchdown_place_; }
  /// Hessian of the scaled touchdown cost, which is constant; lower triangle, row by row.
  [[nodiscard]] const std::array<double, 225>& touchdown_cost() const { return touchdown_cost_; }
  [[nodiscard]] const std::array<int, 11>& liftoff_place() const { return liftoff_place_; }

 private:
  void place_steps(const PlannerConfig& config);
  void write_bounds();
  double transition_values(const Eigen::VectorXd& point, Eigen::VectorXd& slots,
                           Eigen::VectorXd& equalities) const;
  [[nodiscard]] double smoothness_value(const Eigen::VectorXd& point) const;
  void expand_transitions(const Eigen::VectorXd& point, const Eigen::VectorXd& slot_multipliers,
                          const Eigen::VectorXd& equality_multipliers, ChainTerms& terms) const;
  void add_transition_gradient(const ChainTerms& terms, const Eigen::VectorXd& slot_weights,
                               const Eigen::VectorXd& equality_weights,
                               Eigen::VectorXd& gradient) const;
  void add_smoothness_gradient(const ChainTerms& terms, Eigen::VectorXd& gradient) const;

  ChainLayout layout_;
  DecisionBounds bounds_;
  Eigen::VectorXd sizes_;
  std::vector<StanceLaw> takeoff_laws_;
  std::vector<FlightLaw> flight_laws_;
  std::vector<StanceLaw> landing_laws_;
  std::vector<ClearanceLaw> clearance_laws_;
  LiftoffLaw liftoff_law_;
  TouchdownLaw touchdown_law_;
  JointRows<kStanceDof> stance_joints_;
  JointRows<kFlightDof> flight_joints_;
  ChainStep<kStanceDof> takeoff_step_;
  ChainStep<kFlightDof> flight_step_;
  ChainStep<kStanceDof> landing_step_;
  std::vector<double> smoothness_;
  std::vector<StepPlace<kStanceDof>> takeoff_places_;
  std::vector<StepPlace<kFlightDof>> flight_places_;
  std::vector<StepPlace<kStanceDof>> landing_places_;
  std::array<int, 15> touchdown_place_{};
  std::array<int, 11> liftoff_place_{};
  std::array<double, 225> touchdown_cost_{};
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
};

}  // namespace hopscotch::planner
