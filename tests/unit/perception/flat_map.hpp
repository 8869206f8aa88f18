#pragma once

#include <cmath>
#include <limits>

#include "core/terrain_map.hpp"
#include "tests/unit/perception/synthetic_terrain.hpp"

/// Maps written by hand, for tests that start behind the camera.
namespace hopscotch::test {

/// 4 m x 4 m about (1, 0), cells of 1.5 cm, nothing seen.
inline core::TerrainMap unseen_map() {
  core::TerrainMap map;
  map.resolution = 0.015;
  map.size_x = 267;
  map.size_y = 267;
  map.origin_x = -67 * map.resolution;
  map.origin_y = -133 * map.resolution;
  map.cells.assign(267 * 267, {.upper = std::numeric_limits<float>::infinity()});
  return map;
}

/// From where to where across the map [m].
struct Strip {
  double from_y = -2.0;
  double to_y = 2.0;
};

/// Sets all cells whose centre lies in the stretch of x and in the strip of y [m].
inline void set_stretch(core::TerrainMap& map, double from_x, double to_x,
                        const core::TerrainCell& cell, const Strip& strip = {}) {
  for (int iy = 0; iy < map.size_y; ++iy) {
    const double y = map.origin_y + (iy + 0.5) * map.resolution;
    for (int ix = 0; ix < map.size_x; ++ix) {
      const double x = map.origin_x + (ix + 0.5) * map.resolution;
      if (x >= from_x && x < to_x && y >= strip.from_y && y < strip.to_y) map.at(ix, iy) = cell;
    }
  }
}

/// The course as it would be known after a good look from all sides: tops observed to 2 mm, pits
/// crossed by rays at the height of the lowest top.
inline core::TerrainMap known_map(const Course& course) {
  core::TerrainMap map = unseen_map();
  map.frames = 1;
  const double c = std::cos(course.yaw);
  const double s = std::sin(course.yaw);
  for (int iy = 0; iy < map.size_y; ++iy) {
    for (int ix = 0; ix < map.size_x; ++ix) {
      const double x = map.origin_x + (ix + 0.5) * map.resolution;
      const double y = map.origin_y + (iy + 0.5) * map.resolution;
      const double top = top_at(course, c * x + s * y, -s * x + c * y);
      core::TerrainCell& cell = map.at(ix, iy);
      if (top <= -course.pit_depth) {
        cell = {.upper = 0.0F, .state = core::CellState::occluded};
      } else {
        cell = {.height = static_cast<float>(top),
                .variance = 4e-6F,
                .upper = static_cast<float>(top) + 0.004F,
                .state = core::CellState::observed};
      }
    }
  }
  return map;
}

}  // namespace hopscotch::test
