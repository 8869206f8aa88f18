#pragma once

#include "core/terrain_map.hpp"
#include "msgs/messages.hpp"

namespace hopscotch::apps {

/// The square of a map around (x, y) in W [m], as far as the map goes, for people to look at.
[[nodiscard]] msgs::MapView map_view(const core::TerrainMap& map, double x, double y);

}  // namespace hopscotch::apps
