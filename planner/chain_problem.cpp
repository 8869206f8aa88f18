#include "planner/chain_problem.hpp"

#include <algorithm>

namespace hopscotch::planner {

namespace {

template <std::size_t N>
std::array<double, N> gathered(const Eigen::VectorXd& from, const std::array<int, N>& at) {
  std::array<double, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = from(at[i]);
  return out;
}

template <std::size_t N>
std::array<double, N> segment(const Eigen::VectorXd& from, int first) {
  std::array<double, N> out;
  std::copy_n(from.data() + first, N, out.begin());
  return out;
}

/// Copies indices, kNoVariable becoming the appended zero.
template <std::size_t From, std::size_t To>
void copy_places(const std::array<int, From>& from, int zero, std::array<int, To>& to) {
  for (std::size_t i = 0; i < To; ++i) to[i] = from[i] == kNoVariable ? zero : from[i];
}

template <int Dof>
using KnotArray = std::array<double, 2 * static_cast<std::size_t>(Dof)>;

template <int Dof>
void joint_values(const JointRows<Dof>& joints, const KnotArray<Dof>& knot, double* slots) {
  std::array<double, static_cast<std::size_t>(Dof)> rows;
  (void)joints(knot, rows);
  std::copy(rows.begin(), rows.end(), slots);
}

/// The y, v at the end (or the start) of a step.
template <int Dof>
KnotArray<Dof> knot_after(const StepPlace<Dof>& place, const Eigen::VectorXd& x) {
  KnotArray<Dof> knot;
  for (std::size_t i = 0; i < knot.size(); ++i) knot[i] = x(place.at[knot.size() + i]);
  return knot;
}
template <int Dof>
KnotArray<Dof> knot_before(const StepPlace<Dof>& place, const Eigen::VectorXd& x) {
  KnotArray<Dof> knot;
  for (std::size_t i = 0; i < knot.size(); ++i) knot[i] = x(place.at[i]);
  return knot;
}

/// Adds the gradient of weights . joint rows at a knot; they are linear.
template <int Dof>
void scatter_joints(const JointRows<Dof>& joints, const int* at, const double* weight,
                    Eigen::VectorXd& out) {
  const double hip_speed = weight[1] / joints.hip_speed;
  const double ankle_speed = weight[2] / joints.ankle_speed;
  out(at[kShankPitch]) += weight[0];
  out(at[kKneeAngle]) -= weight[0];
  out(at[kTrunkPitch]) -= weight[0];
  out(at[Dof + kShankPitch]) += hip_speed - ankle_speed;
  out(at[Dof + kKneeAngle]) += ankle_speed - hip_speed;
  out(at[Dof + kTrunkPitch]) -= hip_speed;
  if constexpr (Dof == kFlightDof) {
    out(at[Dof + kFootPitch]) += ankle_speed;
    out(at[kFootPitch]) += weight[3];
    out(at[kShankPitch]) -= weight[3];
  }
}

template <std::size_t Rows, std::size_t N>
void scatter_rows(const std::array<std::array<double, N>, Rows>& slope,
                  const std::array<int, N>& at, const double* weight, Eigen::VectorXd& out) {
  for (std::size_t r = 0; r < Rows; ++r) {
    for (std::size_t i = 0; i < N; ++i) out(at[i]) += weight[r] * slope[r][i];
  }
}

template <std::size_t N>
double along_row(const std::array<double, N>& slope, const std::array<int, N>& at,
                 const Eigen::VectorXd& direction) {
  double sum = 0.0;
  for (std::size_t i = 0; i < N; ++i) sum += slope[i] * direction(at[i]);
  return sum;
}

}  // namespace

ChainTerms::ChainTerms(const StepCounts& steps)
    : takeoff(static_cast<std::size_t>(steps.takeoff)),
      flight(static_cast<std::size_t>(steps.flight)),
      landing(static_cast<std::size_t>(steps.landing)),
      momentum(static_cast<std::size_t>(steps.flight)),
      clearance(static_cast<std::size_t>(std::max(0, steps.flight - 1))) {}

ChainProblem::ChainProblem(const PlanarModel& model, const PlanarTask& task,
                           const DecisionLayout& layout)
    : layout_(layout),
      bounds_(decision_bounds(model, task, layout)),
      sizes_(decision_sizes(layout)),
      liftoff_law_(liftoff_law(model)),
      touchdown_law_(touchdown_law(model, task)),
      stance_joints_(joint_rows<kStanceDof>(model.robot, model.config)),
      flight_joints_(joint_rows<kFlightDof>(model.robot, model.config)),
      takeoff_step_(
          model.dynamics, {motor_limits(model.robot, model.config.reserves)},
          ground_rows(model.dynamics.chain(), model.config, model.config.takeoff_cop_margin),
          kCostScale),
      flight_step_(model.dynamics, flight_law(model, task).motors, {}, kCostScale),
      landing_step_(model.dynamics, landing_law(model, task, 0).motors,
                    landing_law(model, task, 0).ground, kCostScale),
      touchdown_place_(touchdown_variables(layout)),
      liftoff_place_(liftoff_variables(layout)) {
  const StepCounts& steps = layout.steps();
  for (int k = 0; k < steps.takeoff; ++k) takeoff_laws_.push_back(takeoff_law(model, task, k));
  for (int k = 0; k < steps.flight; ++k) flight_laws_.push_back(flight_law(model, task));
  for (int k = 0; k < steps.landing; ++k) landing_laws_.push_back(landing_law(model, task, k));
  for (int k = 1; k < steps.flight; ++k) clearance_laws_.push_back(clearance_law(model, task, k));
  for (int k = 0; k + 2 <= steps.takeoff; ++k) {
    smoothness_.push_back(kCostScale * smoothness_law(model.config, k).weight);
  }
  KnotBlock<TouchdownLaw, 15>(touchdown_law_, touchdown_place_)
      .curvature(std::array<double, 15>{}, kCostScale, std::array<double, TouchdownLaw::kRows>{},
                 touchdown_cost_);
  place_steps(model.config);
  write_bounds();
}

void ChainProblem::place_steps(const PlannerConfig& config) {
  const DecisionLayout& layout = layout_.decision();
  const StepCounts& steps = layout_.steps();
  const int zero = layout_.variables();
  takeoff_places_.resize(static_cast<std::size_t>(steps.takeoff));
  flight_places_.resize(static_cast<std::size_t>(steps.flight));
  landing_places_.resize(static_cast<std::size_t>(steps.landing));
  for (int k = 0; k < steps.takeoff; ++k) {
    StepPlace<kStanceDof>& place = takeoff_places_[static_cast<std::size_t>(k)];
    copy_places(layout.takeoff_step_variables(k), zero, place.at);
    place.length = config.takeoff_step(k);
  }
  for (int k = 0; k < steps.flight; ++k) {
    StepPlace<kFlightDof>& place = flight_places_[static_cast<std::size_t>(k)];
    copy_places(layout.flight_step_variables(k), zero, place.at);
    place.length = 1.0;
    place.length_at = layout.flight_step();
  }
  for (int k = 0; k < steps.landing; ++k) {
    StepPlace<kStanceDof>& place = landing_places_[static_cast<std::size_t>(k)];
    copy_places(layout.landing_step_variables(k), zero, place.at);
    place.length = config.landing_share(k);
    place.length_at = layout.landing_step();
  }
}

void ChainProblem::write_bounds() {
  lower_.setConstant(layout_.slots(), -kUnbounded);
  upper_.setConstant(layout_.slots(), kUnbounded);
  const auto write = [this](const auto& law, int first, int rows) {
    law.bounds(std::span(lower_.data() + first, static_cast<std::size_t>(rows)),
               std::span(upper_.data() + first, static_cast<std::size_t>(rows)));
  };
  const StepCounts& steps = layout_.steps();
  for (int k = 0; k < steps.takeoff; ++k) {
    write(takeoff_laws_[static_cast<std::size_t>(k)], layout_.takeoff_rows(k), StanceLaw::kRows);
    write(stance_joints_, layout_.takeoff_joints(k), kStanceDof);
  }
  for (int k = 0; k < steps.flight; ++k) {
    write(flight_laws_[static_cast<std::size_t>(k)], layout_.flight_rows(k), FlightLaw::kRows);
    write(flight_joints_, layout_.flight_joints(k), kFlightDof);
  }
  for (int k = 0; k + 1 < steps.flight; ++k) {
    write(clearance_laws_[static_cast<std::size_t>(k)], layout_.clearance(k), ClearanceLaw::kRows);
  }
  for (int k = 0; k < steps.landing; ++k) {
    write(landing_laws_[static_cast<std::size_t>(k)], layout_.landing_rows(k), StanceLaw::kRows);
    write(stance_joints_, layout_.landing_joints(k), kStanceDof);
  }
  if (steps.landed()) {  // the start is as it is
    lower_.segment<kStanceDof>(layout_.landing_joints(0)).setConstant(-kUnbounded);
    upper_.segment<kStanceDof>(layout_.landing_joints(0)).setConstant(kUnbounded);
  } else {
    const int speeds = layout_.touchdown_speeds();
    lower_(speeds) = -touchdown_law_.speed_along;
    upper_(speeds) = touchdown_law_.speed_along;
    lower_(speeds + 1) = -touchdown_law_.speed_down;
    upper_(speeds + 1) = -touchdown_law_.speed_down_min;
  }
  for (int i = 0; i < layout_.variables(); ++i) {
    if (is_fixed(i)) continue;
    lower_(layout_.variable(i)) = bounds_.lower(i);
    upper_(layout_.variable(i)) = bounds_.upper(i);
  }
}

/// Bounds never cross: a row keeps at least a tenth of its range.
void ChainProblem::correct(const ChainCorrection& correction) {
  auto step = correction.steps.begin();
  for (StepPlace<kStanceDof>& place : takeoff_places_)
    place.shift = step_shift<kStanceDof>(*step++);
  for (StepPlace<kFlightDof>& place : flight_places_) place.shift = step_shift<kFlightDof>(*step++);
  for (StepPlace<kStanceDof>& place : landing_places_)
    place.shift = step_shift<kStanceDof>(*step++);
  write_bounds();
  for (int i = 0; i < layout_.row_slots(); ++i) {
    const double room = 0.45 * (upper_(i) - lower_(i));
    lower_(i) = std::max(lower_(i), std::min(correction.lower(i), lower_(i) + room));
    upper_(i) = std::min(upper_(i), std::max(correction.upper(i), upper_(i) - room));
  }
}

double ChainProblem::values(const Eigen::VectorXd& x, Eigen::VectorXd& slots,
                            Eigen::VectorXd& equalities) const {
  const StepCounts& steps = layout_.steps();
  double cost = 0.0;
  for (int k = 0; k < steps.takeoff; ++k) {
    const StepPlace<kStanceDof>& place = takeoff_place(k);
    cost += step_values(takeoff_laws_[static_cast<std::size_t>(k)], place, x,
                        slots.data() + layout_.takeoff_rows(k),
                        equalities.data() + layout_.takeoff_gap(k));
    joint_values(stance_joints_, knot_after(place, x), slots.data() + layout_.takeoff_joints(k));
  }
  for (int k = 0; k < steps.flight; ++k) {
    const StepPlace<kFlightDof>& place = flight_place(k);
    cost += step_values(flight_laws_[static_cast<std::size_t>(k)], place, x,
                        slots.data() + layout_.flight_rows(k),
                        equalities.data() + layout_.flight_gap(k));
    const std::array<double, 8> knot = knot_after(place, x);
    joint_values(flight_joints_, knot, slots.data() + layout_.flight_joints(k));
    equalities(layout_.momentum(k)) =
        liftoff_law_.dynamics.centroidal_momentum(
            links_from_coordinates(knot[0], knot[1], knot[2], knot[3]),
            links_from_coordinates(knot[4], knot[5], knot[6], knot[7])) -
        x(layout_.decision().momentum());
    if (k + 1 == steps.flight) continue;
    std::array<double, ClearanceLaw::kRowCount> rows;
    (void)clearance_laws_[static_cast<std::size_t>(k)](gathered(x, clearance_place(k)), rows);
    std::copy(rows.begin(), rows.end(), slots.data() + layout_.clearance(k));
  }
  for (int k = 0; k < steps.landing; ++k) {
    const StepPlace<kStanceDof>& place = landing_place(k);
    cost += step_values(landing_laws_[static_cast<std::size_t>(k)], place, x,
                        slots.data() + layout_.landing_rows(k),
                        equalities.data() + layout_.landing_gap(k));
    joint_values(stance_joints_, knot_before(place, x), slots.data() + layout_.landing_joints(k));
  }
  slots.segment(layout_.row_slots(), layout_.variables()) = x.head(layout_.variables());
  return kCostScale * (cost + transition_values(x, slots, equalities)) + smoothness_value(x);
}

double ChainProblem::transition_values(const Eigen::VectorXd& x, Eigen::VectorXd& slots,
                                       Eigen::VectorXd& equalities) const {
  if (layout_.steps().landed()) return 0.0;
  std::array<double, LiftoffLaw::kRows> liftoff;
  (void)liftoff_law_(gathered(x, liftoff_place_), liftoff);
  std::copy(liftoff.begin(), liftoff.end(), equalities.data() + layout_.liftoff());
  equalities(layout_.liftoff()) -= liftoff_law_.ankle.x;
  equalities(layout_.liftoff() + 1) -= liftoff_law_.ankle.z;
  std::array<double, TouchdownLaw::kRows> touchdown;
  const double cost = touchdown_law_(gathered(x, touchdown_place_), touchdown);
  std::copy_n(touchdown.begin(), 5, equalities.data() + layout_.touchdown());
  equalities(layout_.touchdown()) -= touchdown_law_.ankle.x;
  equalities(layout_.touchdown() + 1) -= touchdown_law_.ankle.z;
  slots(layout_.touchdown_speeds()) = touchdown[5];
  slots(layout_.touchdown_speeds() + 1) = touchdown[6];
  return cost;
}

double ChainProblem::smoothness_value(const Eigen::VectorXd& x) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < smoothness_.size(); ++k) {
    const StepPoint<kStanceDof> a = point_of(takeoff_places_[k], x);
    const StepPoint<kStanceDof> b = point_of(takeoff_places_[k + 1], x);
    for (std::size_t d = 0; d < 3; ++d) {
      const double change = b.acceleration[d] - a.acceleration[d];
      sum += smoothness_[k] * change * change;
    }
  }
  return sum;
}

void ChainProblem::expand(const Eigen::VectorXd& x, const Eigen::VectorXd& slot,
                          const Eigen::VectorXd& equality, ChainTerms& terms) const {
  const StepCounts& steps = layout_.steps();
  for (int k = 0; k < steps.takeoff; ++k) {
    expand_step(
        takeoff_step_, takeoff_laws_[static_cast<std::size_t>(k)].objective, takeoff_place(k),
        {x, slot.data() + layout_.takeoff_rows(k), equality.data() + layout_.takeoff_gap(k)},
        terms.takeoff[static_cast<std::size_t>(k)]);
  }
  for (int k = 0; k < steps.flight; ++k) {
    const std::size_t at = static_cast<std::size_t>(k);
    expand_step(flight_step_, flight_laws_[at].objective, flight_place(k),
                {x, slot.data() + layout_.flight_rows(k), equality.data() + layout_.flight_gap(k)},
                terms.flight[at]);
    expand_momentum(liftoff_law_.dynamics, knot_after(flight_place(k), x),
                    equality(layout_.momentum(k)), terms.momentum[at]);
    if (k + 1 == steps.flight) continue;
    expand_clearance(clearance_laws_[at], gathered(x, clearance_place(k)),
                     segment<ClearanceLaw::kRowCount>(slot, layout_.clearance(k)),
                     terms.clearance[at]);
  }
  for (int k = 0; k < steps.landing; ++k) {
    expand_step(
        landing_step_, landing_laws_[static_cast<std::size_t>(k)].objective, landing_place(k),
        {x, slot.data() + layout_.landing_rows(k), equality.data() + layout_.landing_gap(k)},
        terms.landing[static_cast<std::size_t>(k)]);
  }
  expand_transitions(x, slot, equality, terms);
}

void ChainProblem::expand_transitions(const Eigen::VectorXd& x, const Eigen::VectorXd& slot,
                                      const Eigen::VectorXd& equality, ChainTerms& terms) const {
  if (layout_.steps().landed()) return;
  const KnotBlock<LiftoffLaw, 11> liftoff(liftoff_law_, liftoff_place_);
  const std::array<double, 11> at_liftoff = gathered(x, liftoff_place_);
  std::array<double, 11> no_cost{};
  liftoff.slopes(at_liftoff, no_cost, std::span(terms.liftoff.slope[0].data(), 5 * 11));
  liftoff.curvature(at_liftoff, 0.0, std::span(equality.data() + layout_.liftoff(), 5),
                    terms.liftoff.hessian);
  const KnotBlock<TouchdownLaw, 15> touchdown(touchdown_law_, touchdown_place_);
  const std::array<double, 15> at_touchdown = gathered(x, touchdown_place_);
  std::array<double, TouchdownLaw::kRows> multipliers;
  std::copy_n(equality.data() + layout_.touchdown(), 5, multipliers.begin());
  std::copy_n(slot.data() + layout_.touchdown_speeds(), 2, multipliers.begin() + 5);
  touchdown.slopes(at_touchdown, terms.touchdown.gradient,
                   std::span(terms.touchdown.slope[0].data(), 7 * 15));
  for (double& each : terms.touchdown.gradient) each *= kCostScale;
  touchdown.curvature(at_touchdown, 0.0, multipliers, terms.touchdown.hessian);
}

void ChainProblem::gradient(const ChainTerms& terms, const Eigen::VectorXd& slot,
                            const Eigen::VectorXd& equality, Eigen::VectorXd& out) const {
  const StepCounts& steps = layout_.steps();
  out.setZero();
  out.head(layout_.variables()) = slot.segment(layout_.row_slots(), layout_.variables());
  for (int k = 0; k < steps.takeoff; ++k) {
    const StepPlace<kStanceDof>& place = takeoff_place(k);
    step_gradient(terms.takeoff[static_cast<std::size_t>(k)], place,
                  slot.data() + layout_.takeoff_rows(k), equality.data() + layout_.takeoff_gap(k),
                  out);
    scatter_joints(stance_joints_, place.at.data() + 6, slot.data() + layout_.takeoff_joints(k),
                   out);
  }
  for (int k = 0; k < steps.flight; ++k) {
    const StepPlace<kFlightDof>& place = flight_place(k);
    const std::size_t at = static_cast<std::size_t>(k);
    step_gradient(terms.flight[at], place, slot.data() + layout_.flight_rows(k),
                  equality.data() + layout_.flight_gap(k), out);
    scatter_joints(flight_joints_, place.at.data() + 8, slot.data() + layout_.flight_joints(k),
                   out);
    const double momentum = equality(layout_.momentum(k));
    for (std::size_t i = 0; i < 8; ++i) {
      out(place.at[8 + i]) += momentum * terms.momentum[at].slope[i];
    }
    out(layout_.decision().momentum()) -= momentum;
    if (k + 1 == steps.flight) continue;
    scatter_rows(terms.clearance[at].slope, clearance_place(k), slot.data() + layout_.clearance(k),
                 out);
  }
  for (int k = 0; k < steps.landing; ++k) {
    const StepPlace<kStanceDof>& place = landing_place(k);
    step_gradient(terms.landing[static_cast<std::size_t>(k)], place,
                  slot.data() + layout_.landing_rows(k), equality.data() + layout_.landing_gap(k),
                  out);
    scatter_joints(stance_joints_, place.at.data(), slot.data() + layout_.landing_joints(k), out);
  }
  if (!steps.landed()) add_transition_gradient(terms, slot, equality, out);
  add_smoothness_gradient(terms, out);
  out(layout_.variables()) = 0.0;
}

void ChainProblem::add_transition_gradient(const ChainTerms& terms, const Eigen::VectorXd& slot,
                                           const Eigen::VectorXd& equality,
                                           Eigen::VectorXd& out) const {
  scatter_rows(terms.liftoff.slope, liftoff_place_, equality.data() + layout_.liftoff(), out);
  std::array<double, TouchdownLaw::kRows> touchdown;
  std::copy_n(equality.data() + layout_.touchdown(), 5, touchdown.begin());
  std::copy_n(slot.data() + layout_.touchdown_speeds(), 2, touchdown.begin() + 5);
  scatter_rows(terms.touchdown.slope, touchdown_place_, touchdown.data(), out);
  for (std::size_t i = 0; i < 15; ++i) out(touchdown_place_[i]) += terms.touchdown.gradient[i];
}

void ChainProblem::add_smoothness_gradient(const ChainTerms& terms, Eigen::VectorXd& out) const {
  for (std::size_t k = 0; k < smoothness_.size(); ++k) {
    const StepPoint<kStanceDof>& a = terms.takeoff[k].point;
    const StepPoint<kStanceDof>& b = terms.takeoff[k + 1].point;
    for (std::size_t d = 0; d < 3; ++d) {
      const double slope = 2.0 * smoothness_[k] * (b.acceleration[d] - a.acceleration[d]);
      out(takeoff_places_[k].at[3 + d]) += slope / a.h;
      out(takeoff_places_[k].at[9 + d]) -= slope / a.h + slope / b.h;
      out(takeoff_places_[k + 1].at[9 + d]) += slope / b.h;
    }
  }
}

void ChainProblem::slots_along(const ChainTerms& terms, const Eigen::VectorXd& direction,
                               Eigen::VectorXd& slots) const {
  const StepCounts& steps = layout_.steps();
  double* out = slots.data();
  for (int k = 0; k < steps.takeoff; ++k) {
    const StepPlace<kStanceDof>& place = takeoff_place(k);
    step_along(terms.takeoff[static_cast<std::size_t>(k)], place, direction,
               out + layout_.takeoff_rows(k));
    joint_values(stance_joints_, knot_after(place, direction), out + layout_.takeoff_joints(k));
  }
  for (int k = 0; k < steps.flight; ++k) {
    const StepPlace<kFlightDof>& place = flight_place(k);
    step_along(terms.flight[static_cast<std::size_t>(k)], place, direction,
               out + layout_.flight_rows(k));
    joint_values(flight_joints_, knot_after(place, direction), out + layout_.flight_joints(k));
    if (k + 1 == steps.flight) continue;
    const std::array<int, 9> at = clearance_place(k);
    for (std::size_t r = 0; r < ClearanceLaw::kRowCount; ++r) {
      out[layout_.clearance(k) + static_cast<int>(r)] =
          along_row(terms.clearance[static_cast<std::size_t>(k)].slope[r], at, direction);
    }
  }
  for (int k = 0; k < steps.landing; ++k) {
    const StepPlace<kStanceDof>& place = landing_place(k);
    step_along(terms.landing[static_cast<std::size_t>(k)], place, direction,
               out + layout_.landing_rows(k));
    joint_values(stance_joints_, knot_before(place, direction), out + layout_.landing_joints(k));
  }
  for (std::size_t r = 0; r < 2 && !steps.landed(); ++r) {
    out[layout_.touchdown_speeds() + static_cast<int>(r)] =
        along_row(terms.touchdown.slope[5 + r], touchdown_place_, direction);
  }
  slots.segment(layout_.row_slots(), layout_.variables()) = direction.head(layout_.variables());
}

}  // namespace hopscotch::planner
