#pragma once

#include "core/result.hpp"
#include "planner/jump_planner.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// Where the feet of a request's start are.
enum class FeetPlace { origin, target };

/// Projects a request onto the sagittal plane of S: the legs are averaged, the feet taken as flat
/// and fixed, trunk pitch and rate as measured.
/// @param feet At the target: the jump is down, only (part of) its landing is left.
/// @return the refusals that JumpPlanner::plan documents for malformed input.
[[nodiscard]] core::Result<PlanarTask> planar_task(const PlanarModel& model,
                                                   const PlanRequest& request,
                                                   FeetPlace feet = FeetPlace::origin);

}  // namespace hopscotch::planner
