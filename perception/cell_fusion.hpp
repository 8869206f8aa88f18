#pragma once

#include <cstdint>

#include "core/terrain_map.hpp"
#include "perception/perception_config.hpp"

namespace hopscotch::perception {

/// What the mapper remembers of a cell besides the map's own numbers.
struct CellMemory {
  float rival = 0.0F;               ///< Height that would replace the cell's own, in W [m].
  std::uint8_t rival_frames = 0;    ///< Frames in a row that agree on it.
  std::uint8_t through_frames = 0;  ///< Frames whose rays passed below the cell's height.
  std::int8_t cover_votes = 0;  ///< Frames that found the cell covered, less those that did not.
  int last_through_frame = -1;  ///< Number of the newest frame that passed below.
  int edge_frame = -1;          ///< Number of the newest frame in which ground ended here.
};

/// One frame's height of one cell.
struct HeightMeasurement {
  float height = 0.0F;           ///< In W [m].
  float variance = 0.0F;         ///< Of this frame alone [m^2].
  float shared_variance = 0.0F;  ///< Not reduced by fusing more frames [m^2].
};

/// Kalman filter in height, for a cell that the frame found covered. A measurement beyond the gate
/// does not move the cell; when enough frames in a row agree with each other but not with the cell,
/// theirs becomes its height.
void fuse_height(const MapperConfig& config, const HeightMeasurement& measurement,
                 core::TerrainCell& cell, CellMemory& memory);

/// Takes in that a ray passed over the cell at `ray_height` [m, W] in frame number `frame`: bounds
/// a hidden cell, and after enough frames clears an observed one that the rays should have hit.
void fuse_sight(const MapperConfig& config, float ray_height, int frame, core::TerrainCell& cell,
                CellMemory& memory);

/// Takes in that in frame number `frame` a surface ends within the cell, covering less than half of
/// it, at `height` [m, W]. Frames vote: a cell that more frames find covered less than half is no
/// support. Without the vote, the farthest of many noisy frames would decide where an edge is.
void fuse_edge(const MapperConfig& config, float height, int frame, core::TerrainCell& cell,
               CellMemory& memory);

/// Makes the cell observed at `height` [m, W] with standard deviation `sigma` [m].
void set_support(float height, float sigma, core::TerrainCell& cell, CellMemory& memory);

}  // namespace hopscotch::perception
