#include "apps/map_view.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::apps {

namespace {

struct Span {
  int begin = 0;  ///< First cell.
  int size = 0;   ///< [cells]
};

/// At most `kMaxSide` cells around `centre`, in cells of a map that has `cells` of them.
Span span_around(double centre, int cells) {
  if (!std::isfinite(centre) || cells <= 0) return {};
  const double first = std::floor(centre) - 0.5 * msgs::MapView::kMaxSide;
  const double begin = std::clamp(first, 0.0, static_cast<double>(cells));
  const double end = std::clamp(first + msgs::MapView::kMaxSide, begin, static_cast<double>(cells));
  return {static_cast<int>(begin), static_cast<int>(end - begin)};
}

std::int16_t millimetres(float height) {
  constexpr float kMost = 32767.0F;
  return static_cast<std::int16_t>(std::clamp(std::round(1e3F * height), -kMost, kMost));
}

}  // namespace

msgs::MapView map_view(const core::TerrainMap& map, double x, double y) {
  const Span along_x = span_around((x - map.origin_x) / map.resolution, map.size_x);
  const Span along_y = span_around((y - map.origin_y) / map.resolution, map.size_y);
  msgs::MapView view;
  view.stamp = map.stamp;
  view.resolution = map.resolution;
  view.origin_x = map.origin_x + along_x.begin * map.resolution;
  view.origin_y = map.origin_y + along_y.begin * map.resolution;
  view.size_x = along_x.size;
  view.size_y = along_y.size;
  std::size_t at = 0;
  for (int iy = 0; iy < along_y.size; ++iy) {
    for (int ix = 0; ix < along_x.size; ++ix, ++at) {
      const core::TerrainCell& cell = map.at(along_x.begin + ix, along_y.begin + iy);
      view.state[at] = cell.state;
      const bool known = cell.state == core::CellState::observed && std::isfinite(cell.height);
      view.height_mm[at] = known ? millimetres(cell.height) : std::int16_t{0};
    }
  }
  return view;
}

}  // namespace hopscotch::apps
