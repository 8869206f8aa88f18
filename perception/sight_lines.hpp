#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/terrain_map.hpp"
#include "perception/point_bins.hpp"

namespace hopscotch::perception {

/// A cell that a ray passes over, and how high.
struct CellUnderRay {
  std::size_t cell = 0;     ///< Index into TerrainMap::cells.
  float ray_height = 0.0F;  ///< Highest point of the ray above the cell, in W [m].
};

/// Lists the cells of `map` strictly between the two points of a sight line.
/// @param p_WC        Camera [m].
/// @param[out] cells  Overwritten; keeps its memory.
void cells_under_ray(const core::TerrainMap& map, const Eigen::Vector3d& p_WC,
                     const SightLine& line, std::vector<CellUnderRay>& cells);

}  // namespace hopscotch::perception
