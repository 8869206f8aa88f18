#pragma once

#include "core/jump_plan.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// What the check of a finished motion says.
struct CertifiedMotion {
  core::Certificate certificate;  ///< `max_violation` is left to the caller.
  core::PlanPeaks peaks;
};

/// Checks a motion against the physical limits (not the reserves) every millisecond, and its
/// dynamics by integrating the planned torques, held over each step, from each knot to the next.
/// Knows nothing of the optimisation. Margins are distances to a limit divided by it; for the
/// normal force divided by the weight, for clearances by the configured one; near lift-off and
/// touchdown these count only where they are negative by more than the smooth terrain may be too
/// high. `dense_max_violation` is the largest of: a negative margin, the error of the integrated
/// pitches [rad] and rates [of the largest motor speed].
[[nodiscard]] CertifiedMotion certify(const PlanarModel& model, const PlanarTask& task,
                                      const PlanarMotion& motion);

}  // namespace hopscotch::planner
