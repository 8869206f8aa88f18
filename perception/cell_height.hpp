#pragma once

#include <cstdint>
#include <span>

#include "perception/perception_config.hpp"
#include "perception/point_bins.hpp"

namespace hopscotch::perception {

/// What one frame says about one cell.
enum class CellReadingKind : std::uint8_t {
  nothing,     ///< Too few points.
  off_centre,  ///< The points of the surface leave half of the cell or more without one.
  surface,     ///< Points of a surface all over the cell.
};

struct CellReading {
  CellReadingKind kind = CellReadingKind::nothing;
  float height = 0.0F;     ///< Of the topmost surface, in W [m].
  bool has_riser = false;  ///< The points go on below that surface.
};

/// Finds the topmost surface among the points of one cell in one frame. At an edge the points of
/// tread, riser and floor are not averaged: the highest layer that holds its share of points is the
/// surface, so a few flying points above it do not count. A riser puts points into each layer; what
/// the next layer holds is therefore taken off the first before its height and centre are formed.
/// @param expected  Points that a cell at this place gets when a surface covers it.
/// @param points    Reordered.
[[nodiscard]] CellReading read_cell(const MapperConfig& config, double expected,
                                    std::span<MapPoint> points);

}  // namespace hopscotch::perception
