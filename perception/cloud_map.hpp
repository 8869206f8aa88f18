#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/terrain_map.hpp"
#include "perception/perception_config.hpp"

namespace hopscotch::perception {

/// From where a recording was taken.
enum class Viewpoint : std::uint8_t {
  single,  ///< All points from one place: what lies behind an edge was hidden.
  many,    ///< Put together from many places: nothing is known of rays.
};

/// A recording that lies in W.
struct PlacedCloud {
  const std::vector<Eigen::Vector3f>& points;      ///< In W [m]; NaN = none.
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();  ///< Sensor [m].
  Viewpoint viewpoint = Viewpoint::single;
  double residual = 0.0;  ///< Scatter of the points about a plane [m].
};

/// Which ground to map, in W [m].
struct MapArea {
  double from_x = 0.0;
  double to_x = 0.0;
  double half_width = 0.0;
};

/// The height map of one recording, by the same reading of cells as frame by frame. Holes of at
/// most two cells within one surface are bridged for the profile's sake; bridged cells carry a
/// variance that no foothold may rest on.
[[nodiscard]] core::TerrainMap map_cloud(const PerceptionConfig& config, const PlacedCloud& cloud,
                                         const MapArea& area);

}  // namespace hopscotch::perception
