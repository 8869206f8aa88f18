#pragma once

#include "core/result.hpp"
#include "planner/jump_planner.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// Projects a request onto the sagittal plane of S: the legs are averaged, the feet taken as flat
/// and fixed, trunk pitch and rate as measured.
/// @return the refusals that JumpPlanner::plan documents for malformed input.
[[nodiscard]] core::Result<PlanarTask> planar_task(const PlanarModel& model,
                                                   const PlanRequest& request);

}  // namespace hopscotch::planner
