#pragma once

#include <vector>

#include "core/one_step_terrain.hpp"
#include "footstep/foothold_score.hpp"
#include "footstep/footstep_config.hpp"

namespace hopscotch::footstep {

/// Scores places along the jump line as far as ground has been seen: an even grid through the
/// nominal distance, and on treads whose ends are near their centre and the places closest to their
/// ends, which a grid would miss on a short stone or before an edge. Ascending in x.
/// @param goal_x  Mid-point of the soles that ends the run, in S [m]; scored too when finite.
[[nodiscard]] std::vector<Foothold> score_candidates(const FootstepConfig& config,
                                                     const StanceOnMap& stance,
                                                     const core::TerrainProfile& profile,
                                                     double goal_x);

}  // namespace hopscotch::footstep
