#include "perception/sight_lines.hpp"

#include <cmath>

namespace hopscotch::perception {

void cells_under_ray(const core::TerrainMap& map, const Eigen::Vector3d& p_WC,
                     const SightLine& line, std::vector<CellUnderRay>& cells) {
  cells.clear();
  const float resolution = static_cast<float>(map.resolution);
  const float near = line.near.head<2>().norm();
  const float far = line.far.head<2>().norm();
  // What lies next to the ends is measured, and better than a ray just above it can tell.
  const float end_zone = 0.75F * resolution;
  const float start = near + end_zone;
  const float stop = far - end_zone;
  if (!(start < stop)) return;
  const Eigen::Vector3f direction = line.far / far;  // per metre on the ground
  const float grid_x = static_cast<float>(map.origin_x - p_WC.x());
  const float grid_y = static_cast<float>(map.origin_y - p_WC.y());
  std::size_t last = map.cells.size();
  for (float s = start; s <= stop; s += 0.5F * resolution) {
    const int ix = static_cast<int>(std::floor((direction.x() * s - grid_x) / resolution));
    const int iy = static_cast<int>(std::floor((direction.y() * s - grid_y) / resolution));
    if (!map.contains(ix, iy)) continue;
    const std::size_t cell = static_cast<std::size_t>(iy) * static_cast<std::size_t>(map.size_x) +
                             static_cast<std::size_t>(ix);
    if (cell == last) continue;
    last = cell;
    // The ray descends, so it is highest where it enters; the first sample is up to half a
    // resolution inside.
    const float entry = s - 0.5F * resolution;
    cells.push_back({cell, static_cast<float>(p_WC.z()) + direction.z() * entry});
  }
}

}  // namespace hopscotch::perception
