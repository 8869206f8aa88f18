#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "core/terrain_map.hpp"
#include "core/time.hpp"
#include "sim/terrain.hpp"

namespace hopscotch::sim {

/// Name of the geom that stands for the bottom of the pit.
inline constexpr std::string_view kPitFloorName = "pit_floor";
/// Slab i is made of geoms whose names start with this, the index and a dot, e.g. "slab3.top".
inline constexpr std::string_view kSlabPrefix = "slab";

/// Terrain as pieces of an MJCF file.
struct TerrainXml {
  std::string assets;  ///< Textures and materials, for <asset>.
  std::string world;   ///< Lights and geoms, for <worldbody>.
};

/// Boxes from the pit floor up to each slab's top. A sloped slab is a thick plate along its top on
/// a level box. The terrain's contact parameters and friction win over the robot's (geom priority).
[[nodiscard]] TerrainXml terrain_xml(const Terrain& terrain);

/// The map that perfect perception of `seen` would give: every cell observed, the pit at its floor.
/// A square window with cells of the resolution that perception uses.
/// @param centre Of the window, in W [m].
[[nodiscard]] core::TerrainMap seen_terrain_map(const Terrain& seen, const Eigen::Vector2d& centre,
                                                core::Stamp stamp);

}  // namespace hopscotch::sim
