#pragma once

#include <array>

#include "core/control_reference.hpp"
#include "core/jump_plan.hpp"

namespace hopscotch::control {

/// The plan at a time between its knots: positions by cubic Hermite, rates linearly, torques and
/// wrenches linearly between the mid-points of the steps of one phase.
/// @param time Since the start of the plan; clamped to its duration [s].
/// @pre plan.knot_count >= 2. Real-time safe.
[[nodiscard]] core::JumpKnot sample_plan(const core::JumpPlan& plan, double time) noexcept;

/// The last knot at or before `time`. Real-time safe.
[[nodiscard]] std::size_t knot_index(const core::JumpPlan& plan, double time) noexcept;

/// How the plan is laid over what really happened.
struct PlanAnchor {
  Eigen::Vector3d takeoff =
      Eigen::Vector3d::Zero();  ///< Added to planned positions before touchdown [m].
  Eigen::Vector3d landing = Eigen::Vector3d::Zero();  ///< Added to planned positions after it [m].
};

/// The window of eq. (13): `horizon` steps from `time` on with the plan's own step lengths; a step
/// ends early where a phase does, so that contacts change only at knots. Past the end of the plan
/// the last knot is held with the last step length.
/// @param soles Sole centres before and after the flight: [0] takeoff, [1] landing, each per leg,
/// in W.
struct PlannedSoles {
  std::array<Eigen::Vector3d, core::kLegs> takeoff;
  std::array<Eigen::Vector3d, core::kLegs> landing;
};
void fill_reference(const core::JumpPlan& plan, double time, const PlanAnchor& anchor,
                    const PlannedSoles& soles, core::ControlReference& reference) noexcept;

}  // namespace hopscotch::control
