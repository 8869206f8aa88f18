#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/terrain_map.hpp"
#include "perception/cell_fusion.hpp"
#include "perception/perception_config.hpp"

namespace hopscotch::perception {

/// The rolling map: a square window of an endless grid whose cell (0, 0) has its lower corner at
/// the origin of W. Cells keep their place in W when the window moves.
struct MapWindow {
  core::TerrainMap map;
  std::vector<CellMemory> memory;  ///< One per cell of the map.
};

/// An empty window centred at `centre` [m, W].
[[nodiscard]] MapWindow empty_window(const MapperConfig& config, const Eigen::Vector2d& centre);

/// Moves the window so that it is centred at `centre` [m, W] (to the nearest cell) if it is off by
/// more than the re-anchor distance. What leaves the window is forgotten.
void follow(const MapperConfig& config, const Eigen::Vector2d& centre, MapWindow& window);

}  // namespace hopscotch::perception
