#include "planner/chain_kkt_parts.hpp"

namespace hopscotch::planner {

using namespace kkt;  // NOLINT(google-build-using-namespace): the pieces of this class

namespace {

/// The momentum row of a knot in the slots of a flight stage.
std::array<double, 18> momentum_row(const MomentumTerms& terms) {
  std::array<double, 18> row{};
  std::copy(terms.slope.begin(), terms.slope.end(), row.begin());
  row[kFlightMomentum] = -1.0;
  return row;
}

template <std::size_t C, std::size_t N>
void pull_equalities(const StepSweep<4, N>& sweep, Equalities<C, N>& e) {
  for (std::size_t r = 0; r < C; ++r) {
    for (const HalfStep<4>* half : {&sweep.second, &sweep.first}) {
      e.offset[r] += half->gap_share(e.row[r]);
      half->pull_row(e.row[r]);
    }
  }
}

/// What a flight knot costs by itself: joints, bounds, momentum curvature and clearance.
void add_flight_knot(const ChainProblem& problem, const KktInput& input, int k, Quadratic<18>& q) {
  const ChainLayout& layout = problem.layout();
  const int knot = layout.decision().flight(k + 1);
  const bool last = k + 1 == layout.steps().flight;
  const Diagonal diagonal{problem, input};
  diagonal.add_range(knot, kFlightDof, 0, q);
  diagonal.add_range(knot + kFlightDof, kFlightDof, kFlightDof, q);
  add_joints(problem.flight_joints(), input.slot_weights->data() + layout.flight_joints(k),
             input.slot_slopes->data() + layout.flight_joints(k), q);
  const MomentumTerms& momentum = input.terms->momentum[static_cast<std::size_t>(k)];
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 8; ++j) q.m[i][j] += input.curvature * momentum.hessian[i][j];
  }
  if (last) return;
  constexpr std::array<std::size_t, 9> kTo{0, 1, 2, 3, 13, 14, 15, 16, 12};
  const ClearanceTerms& clearance = input.terms->clearance[static_cast<std::size_t>(k)];
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t j = 0; j < 9; ++j) {
      q.m[kTo[i]][kTo[j]] += input.curvature * clearance.hessian[i][j];
    }
  }
  for (std::size_t r = 0; r < ClearanceLaw::kRowCount; ++r) {
    const int slot = layout.clearance(k) + static_cast<int>(r);
    for (std::size_t i = 0; i < 9; ++i) {
      q.p[kTo[i]] += (*input.slot_slopes)(slot)*clearance.slope[r][i];
      for (std::size_t j = 0; j < 9; ++j) {
        q.m[kTo[i]][kTo[j]] +=
            (*input.slot_weights)(slot)*clearance.slope[r][i] * clearance.slope[r][j];
      }
    }
  }
}

}  // namespace

bool ChainKkt::flight_back(const ChainProblem& problem, const KktInput& input) {
  const int last = layout_.steps().flight - 1;
  Quadratic<kFlightSize> q = flight_.back().value;
  for (int k = last; k >= 0; --k) {
    const std::size_t at = static_cast<std::size_t>(k);
    FlightStage& stage = flight_[at];
    add_flight_knot(problem, input, k, q);
    const StepExpansion<kFlightDof>& step = input.terms->flight[at];
    split_step(step.point, input.equalities->data() + layout_.flight_gap(k), 1.0, stage.sweep);
    stage.value = q;
    stage.sweep.second.pull(q);
    add_step(step.terms, 1.0, StepBarrier(input, layout_.flight_rows(k)), q);
    stage.sweep.keep_middle(q);
    stage.sweep.first.pull(q);
    add_length_curvature(step.point, input.curvature, 1.0, q);
    stage.step = q;
    const double momentum = (*input.equalities)(layout_.momentum(k));
    const std::array<double, kFlightSize> row = momentum_row(input.terms->momentum[at]);
    if (k == last ? !arrive(row, momentum, q) : !keep_momentum(row, momentum, stage, q)) {
      return false;
    }
  }
  liftoff_ = q;
  return true;
}

/// The last step must keep the momentum, level the foot and bring the ankle to its place: no
/// choice.
bool ChainKkt::arrive(const std::array<double, kFlightSize>& momentum_row, double momentum,
                      Quadratic<kFlightSize>& q) {
  FlightStage& stage = flight_.back();
  arrival_.row[3] = momentum_row;
  arrival_.offset[3] = momentum;
  arrival_pulled_ = arrival_;
  pull_equalities(stage.sweep, arrival_pulled_);
  if (!solve_for(8, 12, arrival_pulled_, stage.order, stage.control)) return false;
  for (std::size_t i = 0; i < 4; ++i) substitute(stage.order[i], stage.control[i], q);
  return true;
}

/// One acceleration follows from the momentum at the end of the step, the others minimise.
bool ChainKkt::keep_momentum(const std::array<double, kFlightSize>& momentum_row, double momentum,
                             FlightStage& stage, Quadratic<kFlightSize>& q) {
  stage.momentum.row[0] = momentum_row;
  stage.momentum.offset[0] = momentum;
  pull_equalities(stage.sweep, stage.momentum);
  std::array<std::size_t, 1> pivot;
  std::array<Affine<kFlightSize>, 1> solution;
  if (!solve_for(8, 12, stage.momentum, pivot, solution)) return false;
  stage.order[0] = pivot[0];
  stage.control[0] = solution[0];
  substitute(pivot[0], solution[0], q);
  std::size_t next = 1;
  for (std::size_t slot = 8; slot < 12; ++slot) {
    if (slot == pivot[0]) continue;
    stage.order[next] = slot;
    if (!minimise(slot, kPivotMin, q, stage.control[next])) return false;
    ++next;
  }
  return true;
}

bool ChainKkt::liftoff_back(const ChainProblem& problem, const KktInput& input) {
  const DecisionLayout& decision = layout_.decision();
  const Diagonal diagonal{problem, input};
  const LiftoffTerms& terms = input.terms->liftoff;
  diagonal.add_range(decision.liftoff_com(), 4, kFlightCom, liftoff_);
  diagonal.add(decision.momentum(), kFlightMomentum, liftoff_);
  diagonal.add(decision.flight_step(), kFlightLength, liftoff_);
  constexpr std::array<std::size_t, 6> kKnot{0, 1, 2, 4, 5, 6};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const double value = input.curvature * terms.hessian[i * 11 + j];
      liftoff_.m[kKnot[i]][kKnot[j]] += value;
      if (i != j) liftoff_.m[kKnot[j]][kKnot[i]] += value;
    }
  }
  Quadratic<kFlightSize> q = liftoff_;
  for (std::size_t r = 0; r < 5; ++r) {
    Affine<kFlightSize>& by = liftoff_com_[r];
    by = {};
    for (std::size_t i = 0; i < 6; ++i) by.row[kKnot[i]] = -terms.slope[r][i];
    by.offset = -(*input.equalities)(layout_.liftoff() + static_cast<int>(r));
    substitute(kFlightCom + r, by, q);
  }
  if (!minimise(kFlightLength, kPivotMin, q, flight_step_)) return false;
  Quadratic<kTakeoffSize>& value = takeoff_.back().value;
  value = {};
  for (std::size_t i = 0; i < 6; ++i) {
    value.p[i] = q.p[kKnot[i]];
    for (std::size_t j = 0; j < 6; ++j) value.m[i][j] = q.m[kKnot[i]][kKnot[j]];
  }
  return true;
}

/// Multiplier of the momentum after step `k`; z holds the start of the step and its accelerations.
/// @return what it adds to the gradient by y at the end.
std::array<double, 4> ChainKkt::momentum_multiplier(int k, const MomentumTerms& terms,
                                                    const std::array<double, kFlightSize>& z,
                                                    double& multiplier) const {
  const FlightStage& stage = flight_[static_cast<std::size_t>(k)];
  const std::size_t pivot = stage.order[0];
  multiplier = -stage.step.slope(pivot, z) / stage.momentum.row[0][pivot];
  std::array<double, 4> slopes;
  for (std::size_t d = 0; d < 4; ++d) slopes[d] = multiplier * terms.slope[d];
  return slopes;
}

/// The same for the last step and its four equalities.
std::array<double, 4> ChainKkt::arrival_multipliers(const std::array<double, kFlightSize>& z,
                                                    Eigen::VectorXd& multipliers) const {
  const FlightStage& stage = flight_.back();
  std::array<double, 4> gradient;
  for (std::size_t i = 0; i < 4; ++i) gradient[i] = stage.step.slope(stage.order[i], z);
  const std::array<double, 4> nu = solve_multipliers(arrival_pulled_, stage.order, gradient);
  std::array<double, 4> slopes{};
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t d = 0; d < 4; ++d) slopes[d] += nu[r] * arrival_.row[r][d];
  }
  multipliers(layout_.touchdown()) = nu[0];
  multipliers(layout_.touchdown() + 1) = nu[1];
  multipliers(layout_.momentum(layout_.steps().flight - 1)) = nu[3];
  return slopes;
}

void ChainKkt::flight_forward(const ChainTerms& all, Eigen::VectorXd& dx,
                              Eigen::VectorXd& multipliers) const {
  const DecisionLayout& decision = layout_.decision();
  std::array<double, kFlightSize> z{};
  const int start = decision.takeoff(layout_.steps().takeoff);
  for (std::size_t d = 0; d < 3; ++d) {
    z[d] = dx(start + static_cast<int>(d));
    z[4 + d] = dx(start + 3 + static_cast<int>(d));
  }
  z[kFlightLength] = flight_step_.at(z);
  for (std::size_t r = 0; r < 5; ++r) z[kFlightCom + r] = liftoff_com_[r].at(z);
  for (std::size_t r = 0; r < 5; ++r) {
    multipliers(layout_.liftoff() + static_cast<int>(r)) = -liftoff_.slope(kFlightCom + r, z);
  }
  put(z, kFlightCom, 5, decision.liftoff_com(), dx);
  dx(decision.flight_step()) = z[kFlightLength];
  const int last = layout_.steps().flight - 1;
  for (int k = 0; k <= last; ++k) {
    const std::size_t at = static_cast<std::size_t>(k);
    const FlightStage& stage = flight_[at];
    for (std::size_t d = 8; d < 12; ++d) z[d] = 0.0;
    for (std::size_t i = 4; i-- > 0;) z[stage.order[i]] = stage.control[i].at(z);
    const std::array<double, 4> slopes =
        k == last ? arrival_multipliers(z, multipliers)
                  : momentum_multiplier(k, all.momentum[at], z, multipliers(layout_.momentum(k)));
    stage.sweep.first.push(z);
    std::array<double, 4> middle;
    for (std::size_t d = 0; d < 4; ++d) middle[d] = stage.sweep.middle[d].at(z);
    stage.sweep.second.push(z);
    for (std::size_t d = 8; d < 12; ++d) z[d] = 0.0;
    put(z, 0, 8, decision.flight(k + 1), dx);
    for (std::size_t d = 0; d < 4; ++d) {
      multipliers(layout_.flight_gap(k) + static_cast<int>(d)) =
          gap_multiplier(middle[d], stage.value.slope(d, z)) - slopes[d];
    }
  }
  dx(decision.flight(last + 1) + kFootPitch) = 0.0;
}

}  // namespace hopscotch::planner
