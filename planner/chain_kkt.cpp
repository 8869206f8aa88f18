#include "planner/chain_kkt_parts.hpp"

namespace hopscotch::planner {

using namespace kkt;  // NOLINT(google-build-using-namespace): the pieces of this class

ChainKkt::ChainKkt(const ChainLayout& layout)
    : layout_(layout),
      takeoff_(static_cast<std::size_t>(layout.steps().takeoff)),
      flight_(static_cast<std::size_t>(layout.steps().flight)),
      landing_(static_cast<std::size_t>(layout.steps().landing)) {}

bool ChainKkt::solve(const ChainProblem& problem, const KktInput& input, Eigen::VectorXd& direction,
                     Eigen::VectorXd& multipliers) {
  if (!sweep_back(problem, input)) return false;
  direction.setZero();
  if (layout_.steps().landed()) {
    std::array<double, kLandingSize> start{};  // is fixed
    start[kLandingLength] = rest_step_.at(start);
    landing_forward(start, direction, multipliers);
    return true;
  }
  takeoff_forward(direction, multipliers);
  flight_forward(*input.terms, direction, multipliers);
  landing_forward(touchdown_forward(problem, direction, multipliers), direction, multipliers);
  return true;
}

bool ChainKkt::sweep_back(const ChainProblem& problem, const KktInput& input) {
  Quadratic<kLandingSize> landing;
  if (!landing_back(problem, input, landing)) return false;
  if (layout_.steps().landed()) return minimise(kLandingLength, kPivotMin, landing, rest_step_);
  hand_to_touchdown(landing);
  return touchdown_back(problem, input) && flight_back(problem, input) &&
         liftoff_back(problem, input) && takeoff_back(problem, input);
}

bool ChainKkt::takeoff_back(const ChainProblem& problem, const KktInput& input) {
  const Diagonal diagonal{problem, input};
  Quadratic<kTakeoffSize> q = takeoff_.back().value;
  for (int k = layout_.steps().takeoff - 1; k >= 0; --k) {
    const std::size_t at = static_cast<std::size_t>(k);
    TakeoffStage& stage = takeoff_[at];
    const StepExpansion<kStanceDof>& step = input.terms->takeoff[at];
    diagonal.add_range(layout_.decision().takeoff(k + 1), 6, 0, q);
    add_joints(problem.stance_joints(), input.slot_weights->data() + layout_.takeoff_joints(k),
               input.slot_slopes->data() + layout_.takeoff_joints(k), q);
    stage.value = q;
    for (std::size_t d = 0; d < 3; ++d) {  // "u of the step before" is u of this step
      Affine<kTakeoffSize> same;
      same.row[6 + d] = 1.0;
      substitute(9 + d, same, q);
    }
    split_step(step.point, input.equalities->data() + layout_.takeoff_gap(k), 0.0, stage.sweep);
    stage.sweep.second.pull(q);
    add_step(step.terms, 0.0, StepBarrier(input, layout_.takeoff_rows(k)), q);
    stage.sweep.keep_middle(q);
    stage.sweep.first.pull(q);
    if (k > 0) {
      const double weight = 2.0 * problem.smoothness(k - 1);
      const StepPoint<kStanceDof>& before = input.terms->takeoff[at - 1].point;
      for (std::size_t d = 0; d < 3; ++d) {
        const double slope = weight * (step.point.acceleration[d] - before.acceleration[d]);
        add_form(weight, slope, {{{6 + d, 1.0}, {9 + d, -1.0}, {0, 0.0}, {0, 0.0}}}, q);
      }
    }
    for (std::size_t d = 3; d-- > 0;) {
      if (!minimise(6 + d, kPivotMin, q, stage.control[d])) return false;
    }
  }
  return true;
}

void ChainKkt::takeoff_forward(Eigen::VectorXd& dx, Eigen::VectorXd& multipliers) const {
  const DecisionLayout& decision = layout_.decision();
  std::array<double, kTakeoffSize> z{};
  for (int k = 0; k < layout_.steps().takeoff; ++k) {
    const std::size_t at = static_cast<std::size_t>(k);
    const TakeoffStage& stage = takeoff_[at];
    for (std::size_t d = 0; d < 3; ++d) z[6 + d] = 0.0;
    for (std::size_t d = 0; d < 3; ++d) z[6 + d] = stage.control[d].at(z);
    stage.sweep.first.push(z);
    std::array<double, 3> middle;
    for (std::size_t d = 0; d < 3; ++d) middle[d] = stage.sweep.middle[d].at(z);
    stage.sweep.second.push(z);
    for (std::size_t d = 0; d < 3; ++d) {
      z[9 + d] = z[6 + d];
      z[6 + d] = 0.0;
    }
    put(z, 0, 6, decision.takeoff(k + 1), dx);
    for (std::size_t d = 0; d < 3; ++d) {
      multipliers(layout_.takeoff_gap(k) + static_cast<int>(d)) =
          gap_multiplier(middle[d], stage.value.slope(d, z));
    }
  }
}

}  // namespace hopscotch::planner
