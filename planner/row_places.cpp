#include "planner/row_places.hpp"

namespace hopscotch::planner {

RowPlaces::RowPlaces(const ChainProblem& problem) {
  const ChainLayout& layout = problem.layout();
  const StepCounts& steps = layout.steps();
  for (int k = 0; k < steps.takeoff; ++k) {
    add_equalities(layout.takeoff_gap(k), kStanceDof);
    add_slots(problem, layout.takeoff_rows(k), ChainLayout::kStanceRows);
    add_slots(problem, layout.takeoff_joints(k), kStanceDof);
  }
  if (!steps.landed()) add_equalities(layout.liftoff(), LiftoffLaw::kRows);
  for (int k = 0; k < steps.flight; ++k) {
    add_equalities(layout.flight_gap(k), kFlightDof);
    add_slots(problem, layout.flight_rows(k), ChainLayout::kFlightRows);
    add_slots(problem, layout.flight_joints(k), kFlightDof);
    add_equalities(layout.momentum(k), MomentumLaw::kRows);
    if (k + 1 < steps.flight) {
      add_slots(problem, layout.clearance(k), ChainLayout::kClearanceRows);
    }
  }
  if (!steps.landed()) {
    add_equalities(layout.touchdown(), TouchdownLaw::kRows - 2);
    add_slots(problem, layout.touchdown_speeds(), 2);
  }
  for (int k = 0; k < steps.landing; ++k) {
    add_equalities(layout.landing_gap(k), kStanceDof);
    add_slots(problem, layout.landing_rows(k), ChainLayout::kStanceRows);
    add_slots(problem, layout.landing_joints(k), kStanceDof);
  }
}

Eigen::VectorXd RowPlaces::gather(const Eigen::VectorXd& slots,
                                  const Eigen::VectorXd& equalities) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(list_.size()));
  Eigen::Index row = 0;
  for (const RowPlace& place : list_) {
    out(row++) = place.is_equality ? equalities(place.at) : slots(place.at);
  }
  return out;
}

void RowPlaces::add_equalities(int first, int count) {
  for (int i = first; i < first + count; ++i) list_.push_back({true, i});
}

void RowPlaces::add_slots(const ChainProblem& problem, int first, int count) {
  for (int i = first; i < first + count; ++i) {
    if (problem.lower()(i) > -kUnbounded || problem.upper()(i) < kUnbounded) {
      list_.push_back({false, i});
    }
  }
}

}  // namespace hopscotch::planner
