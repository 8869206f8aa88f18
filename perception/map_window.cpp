#include "perception/map_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hopscotch::perception {

namespace {

constexpr core::TerrainCell kUnseen{.upper = std::numeric_limits<float>::infinity()};

int corner_cell(const MapperConfig& config, double centre) {
  return static_cast<int>(std::lround((centre - 0.5 * config.window) / config.resolution));
}

/// Copies the part of a square grid that stays in the window after a shift by (dx, dy) cells.
template <typename T>
std::vector<T> shifted(const std::vector<T>& cells, int size, Eigen::Vector2i shift, T fresh) {
  std::vector<T> result(cells.size(), fresh);
  const int first = std::clamp(-shift.x(), 0, size);
  const int last = std::clamp(size - shift.x(), 0, size);
  for (int iy = 0; iy < size; ++iy) {
    const int from = iy + shift.y();
    if (from < 0 || from >= size || first >= last) continue;
    const std::ptrdiff_t source = static_cast<std::ptrdiff_t>(from) * size + shift.x();
    const std::ptrdiff_t target = static_cast<std::ptrdiff_t>(iy) * size;
    std::copy(cells.begin() + source + first, cells.begin() + source + last,
              result.begin() + target + first);
  }
  return result;
}

}  // namespace

MapWindow empty_window(const MapperConfig& config, const Eigen::Vector2d& centre) {
  MapWindow window;
  core::TerrainMap& map = window.map;
  map.resolution = config.resolution;
  map.size_x = static_cast<int>(std::ceil(config.window / config.resolution));
  map.size_y = map.size_x;
  map.origin_x = corner_cell(config, centre.x()) * config.resolution;
  map.origin_y = corner_cell(config, centre.y()) * config.resolution;
  map.cells.assign(static_cast<std::size_t>(map.size_x) * static_cast<std::size_t>(map.size_y),
                   kUnseen);
  window.memory.assign(map.cells.size(), CellMemory{});
  return window;
}

void follow(const MapperConfig& config, const Eigen::Vector2d& centre, MapWindow& window) {
  core::TerrainMap& map = window.map;
  const Eigen::Vector2i now(static_cast<int>(std::lround(map.origin_x / config.resolution)),
                            static_cast<int>(std::lround(map.origin_y / config.resolution)));
  const Eigen::Vector2i wanted(corner_cell(config, centre.x()), corner_cell(config, centre.y()));
  const Eigen::Vector2i shift = wanted - now;
  if (shift.cast<double>().norm() * config.resolution <= config.reanchor_distance) return;
  map.cells = shifted(map.cells, map.size_x, shift, kUnseen);
  window.memory = shifted(window.memory, map.size_x, shift, CellMemory{});
  map.origin_x = wanted.x() * config.resolution;
  map.origin_y = wanted.y() * config.resolution;
}

}  // namespace hopscotch::perception
