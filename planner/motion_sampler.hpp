#pragma once

#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// The closed-form guess as a function of phase and time: where formulations with other steps start
/// from.
class MotionSampler {
 public:
  MotionSampler(const PlanarModel& model, const PlanarTask& task);

  /// @param share Of the phase's duration, 0 to 1.
  [[nodiscard]] PlanarInstant at(core::JumpPhase phase, double share) const;
  [[nodiscard]] const PlanarMotion& motion() const { return motion_; }
  [[nodiscard]] double duration(core::JumpPhase phase) const;

 private:
  [[nodiscard]] double begin(core::JumpPhase phase) const;

  const PlanarModel& model_;
  PlanarMotion motion_;
};

/// Rates of links and ankle, for formulations that have only their places; at rest at both ends.
void add_rates_by_differences(PlanarMotion& motion);

/// Completes a motion that another formulation found: accelerations from rates, times from steps,
/// and what the chain of links has when its feet leave the ground.
void complete_motion(const PlanarModel& model, const PlanarTask& task, PlanarMotion& motion);

}  // namespace hopscotch::planner
