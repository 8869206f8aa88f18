#pragma once

#include <array>
#include <span>

#include "model/planar_dynamics.hpp"
#include "planner/planner_config.hpp"

namespace hopscotch::planner {

/// Cost of one step, eq. (8): posture, rates, torques and, beyond the paper, accelerations and
/// trunk pitch.
struct StepObjective {
  CostWeights weights;
  model::PlanarJoints<double> reference{};  ///< q_0: joint angles of the final posture [rad].
  double trunk_pitch = 0.0;                 ///< Of the final posture [rad].

  /// @param share Part of the phase that the step is; all shares of a phase add up to 1.
  StepObjective(const CostWeights& per_phase, double share, const model::LinkArray<double>& posture)
      : weights(per_phase),
        reference(model::joints_from_links(posture)),
        trunk_pitch(posture[model::kTrunk]) {
    weights.posture *= share;
    weights.rate *= share;
    weights.torque *= share;
    weights.acceleration *= share;
    weights.trunk_pitch *= share;
  }

  template <typename T>
  [[nodiscard]] T operator()(const model::LinkArray<T>& a, const model::LinkArray<T>& w,
                             const model::LinkArray<T>& acceleration,
                             const model::PlanarJoints<T>& tau) const {
    const model::PlanarJoints<T> q = model::joints_from_links(a);
    const model::PlanarJoints<T> dq = model::joints_from_links(w);
    const T hip = q.hip - reference.hip;
    const T knee = q.knee - reference.knee;
    const T ankle = q.ankle - reference.ankle;
    const T trunk = a[model::kTrunk] - trunk_pitch;
    T sum = weights.posture * (hip * hip + knee * knee + ankle * ankle);
    sum = sum + weights.rate * (dq.hip * dq.hip + dq.knee * dq.knee + dq.ankle * dq.ankle);
    if (weights.torque > 0.0) {
      sum =
          sum + weights.torque * (tau.hip * tau.hip + tau.knee * tau.knee + tau.ankle * tau.ankle);
    }
    for (const T& each : acceleration) sum = sum + weights.acceleration * (each * each);
    return sum + weights.trunk_pitch * (trunk * trunk);
  }
};

/// Cost on the change of acceleration from one step to the next, so that the push is smooth and
/// can be tracked. Arguments: the rates of one coordinate at three successive knots.
struct SmoothnessLaw {
  static constexpr int kRows = 0;
  double weight = 0.0;
  double first_step = 0.0;   ///< Between the first two knots [s].
  double second_step = 0.0;  ///< [s]

  template <typename T>
  T operator()(const std::array<T, 3>& v, std::array<T, 0>& /*rows*/) const {
    const T change = (v[2] - v[1]) * (1.0 / second_step) - (v[1] - v[0]) * (1.0 / first_step);
    return weight * (change * change);
  }
  void bounds(std::span<double> /*lower*/, std::span<double> /*upper*/) const {}
};

}  // namespace hopscotch::planner
