#pragma once

#include <vector>

#include "core/terrain_map.hpp"
#include "perception/one_step.hpp"
#include "perception/tread.hpp"

namespace hopscotch::perception {

/// Looks along many lines of both foot tracks where each tread ends and the next one begins, so
/// that an edge askew is one place with an angle and not a zone without support. The last tread is
/// followed by none: its break has no start.
[[nodiscard]] std::vector<TreadBreak> find_breaks(const core::TerrainMap& map,
                                                  const StancePose& stance,
                                                  const std::vector<Tread>& treads);

}  // namespace hopscotch::perception
