#include "planner/chain_kkt_parts.hpp"

namespace hopscotch::planner {

using namespace kkt;  // NOLINT(google-build-using-namespace): the pieces of this class

/// @param[out] q Of the start of the landing, its slots of accelerations used up.
bool ChainKkt::landing_back(const ChainProblem& problem, const KktInput& input,
                            Quadratic<kLandingSize>& q) {
  const Diagonal diagonal{problem, input};
  const DecisionLayout& decision = layout_.decision();
  const int last = layout_.steps().landing - 1;
  q = {};  // of the end knot, which is fixed: nothing
  for (int k = last; k >= 0; --k) {
    LandingStage& stage = landing_[static_cast<std::size_t>(k)];
    const StepExpansion<kStanceDof>& step = input.terms->landing[static_cast<std::size_t>(k)];
    const StepPoint<kStanceDof>& point = step.point;
    const double share = problem.landing_place(k).length;
    const double* gap = input.equalities->data() + layout_.landing_gap(k);
    split_step(point, gap, share, stage.sweep);
    stage.value = q;
    stage.sweep.second.pull(q);
    add_step(step.terms, share, StepBarrier(input, layout_.landing_rows(k)), q);
    stage.sweep.keep_middle(q);
    stage.sweep.first.pull(q);
    add_length_curvature(point, input.curvature, share, q);
    if (k == last) {
      end_landing(point, share, gap, q);
    } else if (k == last - 1) {
      if (!close_last_gap(q)) return false;
    } else {
      for (std::size_t d = 3; d-- > 0;) {
        if (!minimise(6 + d, kPivotMin, q, stage.control[d])) return false;
      }
    }
    add_joints(problem.stance_joints(), input.slot_weights->data() + layout_.landing_joints(k),
               input.slot_slopes->data() + layout_.landing_joints(k), q);
    if (k > 0) {
      diagonal.add_range(decision.landing(k), 6, 0, q);
    } else if (!layout_.steps().landed()) {
      diagonal.add_range(decision.touchdown_rates(), 3, 3, q);
    }
  }
  diagonal.add(decision.landing_step(), kLandingLength, q);
  return true;
}

/// The last step ends at rest in a fixed knot: v' = 0 gives its accelerations, and its gap becomes
/// an equality of the knot before.
void ChainKkt::end_landing(const StepPoint<kStanceDof>& point, double share, const double* gap,
                           Quadratic<kLandingSize>& q) {
  for (std::size_t d = 0; d < 3; ++d) {
    Affine<kLandingSize>& control = landing_.back().control[d];
    control = {};
    control.row[3 + d] = -1.0 / point.h;
    control.row[kLandingLength] = -share * point.acceleration[d] / point.h;
    substitute(6 + d, control, q);
    last_gap_.row[d] = {};
    last_gap_.row[d][d] = -1.0;
    last_gap_.row[d][3 + d] = -0.5 * point.h;
    last_gap_.row[d][kLandingLength] = -share * point.middle_rate[d];
    last_gap_.offset[d] = gap[d];
  }
}

/// The step before has no choice: its accelerations must close the gap of the last step.
bool ChainKkt::close_last_gap(Quadratic<kLandingSize>& q) {
  LandingStage& stage = landing_[landing_.size() - 2];
  last_gap_pulled_ = last_gap_;
  for (std::size_t d = 0; d < 3; ++d) {
    for (const HalfStep<3>* half : {&stage.sweep.second, &stage.sweep.first}) {
      last_gap_pulled_.offset[d] += half->gap_share(last_gap_pulled_.row[d]);
      half->pull_row(last_gap_pulled_.row[d]);
    }
  }
  std::array<Affine<kLandingSize>, 3> solution;
  if (!solve_for(6, 9, last_gap_pulled_, last_gap_pivots_, solution)) return false;
  last_gap_step_ = q;
  for (std::size_t i = 0; i < 3; ++i) {
    substitute(last_gap_pivots_[i], solution[i], q);
    stage.control[last_gap_pivots_[i] - 6] = solution[i];
  }
  return true;
}

/// From the slots of the first landing step into those of the touchdown.
void ChainKkt::hand_to_touchdown(const Quadratic<kLandingSize>& q) {
  touchdown_ = {};
  std::array<std::size_t, kLandingSize> to{0,          1, 2, kAfter, kAfter + 1,
                                           kAfter + 2, 0, 0, 0,      kTouchdownLandingStep};
  for (std::size_t i = 0; i < kLandingSize; ++i) {
    if (i >= 6 && i < 9) continue;
    touchdown_.p[to[i]] = q.p[i];
    for (std::size_t j = 0; j < kLandingSize; ++j) {
      if (j < 6 || j >= 9) touchdown_.m[to[i]][to[j]] = q.m[i][j];
    }
  }
}

namespace {

void add_touchdown_speeds(const ChainLayout& layout, const KktInput& input, Quadratic<16>& q) {
  const TouchdownTerms& terms = input.terms->touchdown;
  for (std::size_t r = 0; r < 2; ++r) {
    const int slot = layout.touchdown_speeds() + static_cast<int>(r);
    const std::array<double, 15>& row = terms.slope[5 + r];
    for (std::size_t i = 0; i < 15; ++i) {
      q.p[i] += (*input.slot_slopes)(slot)*row[i];
      for (std::size_t j = 0; j < 15; ++j) {
        q.m[i][j] += (*input.slot_weights)(slot)*row[i] * row[j];
      }
    }
  }
}

}  // namespace

bool ChainKkt::touchdown_back(const ChainProblem& problem, const KktInput& input) {
  const TouchdownTerms& terms = input.terms->touchdown;
  std::array<std::size_t, 15> to;
  for (std::size_t i = 0; i < 15; ++i) to[i] = i;
  add_lower(problem.touchdown_cost(), 1.0, to, touchdown_);
  add_lower(terms.hessian, input.curvature, to, touchdown_);
  for (std::size_t i = 0; i < 15; ++i) touchdown_.p[i] += terms.gradient[i];
  add_touchdown_speeds(layout_, input, touchdown_);
  for (std::size_t r = 0; r < 3; ++r) {
    touchdown_rows_.row[r] = {};
    std::copy(terms.slope[2 + r].begin(), terms.slope[2 + r].end(), touchdown_rows_.row[r].begin());
    touchdown_rows_.offset[r] = (*input.equalities)(layout_.touchdown() + 2 + static_cast<int>(r));
  }
  if (!solve_for(kAfter, kTouchdownCom, touchdown_rows_, touchdown_pivots_, after_)) return false;
  Quadratic<kTouchdownSize> q = touchdown_;
  for (std::size_t i = 0; i < 3; ++i) substitute(touchdown_pivots_[i], after_[i], q);
  if (!minimise(kTouchdownLandingStep, kPivotMin, q, landing_step_)) return false;
  hand_to_flight(terms, q, *input.equalities);
  return true;
}

/// From the slots of the touchdown into those of the last flight step.
void ChainKkt::hand_to_flight(const TouchdownTerms& terms, const Quadratic<kTouchdownSize>& q,
                              const Eigen::VectorXd& equalities) {
  Quadratic<kFlightSize>& value = flight_.back().value;
  value = {};
  arrival_ = {};
  for (std::size_t i = 0; i < 15; ++i) {
    if (is_after(i)) continue;
    value.p[kTouchdownToFlight[i]] = q.p[i];
    for (std::size_t j = 0; j < 15; ++j) {
      if (!is_after(j)) value.m[kTouchdownToFlight[i]][kTouchdownToFlight[j]] = q.m[i][j];
    }
    for (std::size_t r = 0; r < 2; ++r) arrival_.row[r][kTouchdownToFlight[i]] = terms.slope[r][i];
  }
  for (std::size_t r = 0; r < 2; ++r) {
    arrival_.offset[r] = equalities(layout_.touchdown() + static_cast<int>(r));
  }
  arrival_.row[2][kFootPitch] = 1.0;  // stays level
}

/// @return the step of the first landing knot and of dt^l.
std::array<double, ChainKkt::kLandingSize> ChainKkt::touchdown_forward(
    const ChainProblem& problem, Eigen::VectorXd& dx, Eigen::VectorXd& multipliers) const {
  std::array<double, kTouchdownSize> z{};
  for (std::size_t i = 0; i < 15; ++i) {
    if (!is_after(i)) z[i] = dx(problem.touchdown_place()[i]);
  }
  z[kTouchdownLandingStep] = landing_step_.at(z);
  for (std::size_t i = 0; i < 3; ++i) z[touchdown_pivots_[i]] = after_[i].at(z);
  std::array<double, 3> gradient;
  for (std::size_t i = 0; i < 3; ++i) gradient[i] = touchdown_.slope(touchdown_pivots_[i], z);
  const std::array<double, 3> nu = solve_multipliers(touchdown_rows_, touchdown_pivots_, gradient);
  for (std::size_t r = 0; r < 3; ++r) {
    multipliers(layout_.touchdown() + 2 + static_cast<int>(r)) = nu[r];
  }
  put(z, kAfter, 3, layout_.decision().touchdown_rates(), dx);
  std::array<double, kLandingSize> start{z[0], z[1], z[2], z[kAfter], z[kAfter + 1], z[kAfter + 2]};
  start[kLandingLength] = z[kTouchdownLandingStep];
  return start;
}

/// @param s At the first landing knot.
void ChainKkt::landing_forward(std::array<double, kLandingSize> s, Eigen::VectorXd& dx,
                               Eigen::VectorXd& multipliers) const {
  const DecisionLayout& decision = layout_.decision();
  dx(decision.landing_step()) = s[kLandingLength];
  const int last = layout_.steps().landing - 1;
  std::array<double, 3> last_gap{};
  for (int k = 0; k < last; ++k) {
    const std::size_t at = static_cast<std::size_t>(k);
    const LandingStage& stage = landing_[at];
    for (std::size_t d = 0; d < 3; ++d) s[6 + d] = 0.0;
    for (std::size_t d = 0; d < 3; ++d) s[6 + d] = stage.control[d].at(s);
    if (k == last - 1) {
      std::array<double, 3> slope;
      for (std::size_t i = 0; i < 3; ++i) slope[i] = last_gap_step_.slope(last_gap_pivots_[i], s);
      last_gap = solve_multipliers(last_gap_pulled_, last_gap_pivots_, slope);
    }
    stage.sweep.first.push(s);
    std::array<double, 3> middle;
    for (std::size_t d = 0; d < 3; ++d) middle[d] = stage.sweep.middle[d].at(s);
    stage.sweep.second.push(s);
    for (std::size_t d = 0; d < 3; ++d) s[6 + d] = 0.0;
    put(s, 0, 6, decision.landing(k + 1), dx);
    for (std::size_t d = 0; d < 3; ++d) {
      // The gap of the last step is -1 by y of the knot before it.
      const double of_gap = k == last - 1 ? last_gap[d] : 0.0;
      multipliers(layout_.landing_gap(k) + static_cast<int>(d)) =
          gap_multiplier(middle[d], stage.value.slope(d, s)) + of_gap;
    }
  }
  // The last step ends in a fixed knot: its gap, an equality of the knot before, is closed there.
  const LandingStage& stage = landing_.back();
  for (std::size_t d = 0; d < 3; ++d) s[6 + d] = stage.control[d].at(s);
  stage.sweep.first.push(s);
  for (std::size_t d = 0; d < 3; ++d) {
    multipliers(layout_.landing_gap(last) + static_cast<int>(d)) =
        last_gap[d] - 0.5 * stage.sweep.middle[d].at(s);
  }
}

}  // namespace hopscotch::planner
