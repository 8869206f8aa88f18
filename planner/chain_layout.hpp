#pragma once

#include "planner/decision_layout.hpp"
#include "planner/flight_phase.hpp"

namespace hopscotch::planner {

/// Who lives where in the arrays of the chain solver. A *slot* is an inequality: a row of a block
/// or a bounded variable. An *equality* is a row whose bounds are equal. Both run along the chain.
class ChainLayout {
 public:
  explicit ChainLayout(const DecisionLayout& decision)
      : decision_(decision), steps_(decision.steps()) {}

  [[nodiscard]] const DecisionLayout& decision() const { return decision_; }
  [[nodiscard]] const StepCounts& steps() const { return steps_; }
  [[nodiscard]] int variables() const { return decision_.size(); }

  // Slots.
  [[nodiscard]] int takeoff_rows(int step) const { return kStanceRows * step; }
  /// Of the knot after step `step`.
  [[nodiscard]] int takeoff_joints(int step) const {
    return takeoff_rows(steps_.takeoff) + kStanceDof * step;
  }
  [[nodiscard]] int flight_rows(int step) const {
    return takeoff_joints(steps_.takeoff) + kFlightRows * step;
  }
  [[nodiscard]] int flight_joints(int step) const {
    return flight_rows(steps_.flight) + kFlightDof * step;
  }
  /// Of the knot after step `step`; there is none after the last.
  [[nodiscard]] int clearance(int step) const {
    return flight_joints(steps_.flight) + kClearanceRows * step;
  }
  [[nodiscard]] int touchdown_speeds() const { return clearance(steps_.flight - 1); }
  [[nodiscard]] int landing_rows(int step) const {
    return (steps_.landed() ? 0 : touchdown_speeds() + 2) + kStanceRows * step;
  }
  /// Of the knot before step `step`.
  [[nodiscard]] int landing_joints(int step) const {
    return landing_rows(steps_.landing) + kStanceDof * step;
  }
  [[nodiscard]] int variable(int at) const { return landing_joints(steps_.landing) + at; }
  [[nodiscard]] int slots() const { return variable(variables()); }
  /// Slots that are rows.
  [[nodiscard]] int row_slots() const { return variable(0); }

  // Equalities.
  [[nodiscard]] int takeoff_gap(int step) const { return kStanceDof * step; }
  [[nodiscard]] int liftoff() const { return takeoff_gap(steps_.takeoff); }
  [[nodiscard]] int flight_gap(int step) const { return liftoff() + 5 + (kFlightDof + 1) * step; }
  [[nodiscard]] int momentum(int step) const { return flight_gap(step) + kFlightDof; }
  [[nodiscard]] int touchdown() const { return flight_gap(steps_.flight); }
  [[nodiscard]] int landing_gap(int step) const {
    return (steps_.landed() ? 0 : touchdown() + 5) + kStanceDof * step;
  }
  [[nodiscard]] int equalities() const { return landing_gap(steps_.landing); }

  static constexpr int kStanceRows = MotorRows::kRows + GroundRows::kRows;
  static constexpr int kFlightRows = MotorRows::kRows;
  static constexpr int kClearanceRows = ClearanceLaw::kRows;

 private:
  DecisionLayout decision_;
  StepCounts steps_;
};

}  // namespace hopscotch::planner
