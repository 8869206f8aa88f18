#pragma once

#include <optional>

#include "core/jump_plan.hpp"
#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::planner {

/// A jump that can be planned, near one that cannot.
struct NearestTarget {
  StepRequest step;
  core::CertificateEntry binding;  ///< Its tightest limit.
};

/// Looks for the nearest jump that plans: from the refused one back towards an easy jump, in
/// distance and height together and in each alone, to the side likewise; by bisection, so the
/// number of solves is bounded. Distances in metres and radians count alike.
/// @param request The refused one; its target is replaced.
/// @return nothing if not even the easy jump plans from this start.
[[nodiscard]] std::optional<NearestTarget> nearest_target(JumpPlanner& planner,
                                                          const PlanRequest& request,
                                                          const StepRequest& refused,
                                                          const model::RobotParameters& robot);

}  // namespace hopscotch::planner
