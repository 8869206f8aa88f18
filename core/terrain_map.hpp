#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/time.hpp"

namespace hopscotch::core {

/// What is known of a patch of ground.
enum class CellState : std::uint8_t {
  never_seen,  ///< No ray ever reached it.
  occluded,    ///< Hidden; only `upper` bounds it.
  observed,    ///< Measured.
};

/// One square of ground.
struct TerrainCell {
  float height = 0.0F;    ///< Mean, in W [m]; meaningful when observed.
  float variance = 0.0F;  ///< Of height [m^2].
  float upper = 0.0F;     ///< Nothing sticks out above this, in W [m]; infinity when unknown.
  CellState state = CellState::never_seen;
};

/// Height grid with axes along W. Cell (ix, iy) covers
/// [origin_x + ix r, origin_x + (ix + 1) r) x [origin_y + iy r, origin_y + (iy + 1) r).
struct TerrainMap {
  Stamp stamp;                     ///< Of the newest frame in it.
  double origin_x = 0.0;           ///< Lower corner, in W [m].
  double origin_y = 0.0;           ///< Lower corner, in W [m].
  double resolution = 0.0;         ///< r [m]
  int size_x = 0;                  ///< [cells]
  int size_y = 0;                  ///< [cells]
  int frames = 0;                  ///< Depth frames fused so far.
  std::vector<TerrainCell> cells;  ///< iy major: cells[iy * size_x + ix].

  [[nodiscard]] bool contains(int ix, int iy) const {
    return ix >= 0 && iy >= 0 && ix < size_x && iy < size_y;
  }
  /// @pre contains(ix, iy)
  [[nodiscard]] const TerrainCell& at(int ix, int iy) const {
    return cells[static_cast<std::size_t>(iy) * static_cast<std::size_t>(size_x) +
                 static_cast<std::size_t>(ix)];
  }
  [[nodiscard]] TerrainCell& at(int ix, int iy) {
    return cells[static_cast<std::size_t>(iy) * static_cast<std::size_t>(size_x) +
                 static_cast<std::size_t>(ix)];
  }
};

}  // namespace hopscotch::core
