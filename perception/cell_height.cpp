#include "perception/cell_height.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::perception {

namespace {

/// A surface next to a riser counts when it holds this share of a covered cell's points: half, less
/// the scatter of the riser's own points.
constexpr double kHalfCovered = 0.4;

/// Sum over points of one layer.
struct Layer {
  float count = 0.0F;
  MapPoint sum;

  void add(const MapPoint& point) {
    count += 1.0F;
    sum.height += point.height;
    sum.offset_x += point.offset_x;
    sum.offset_y += point.offset_y;
  }
};

Layer sum_of(std::span<const MapPoint> points) {
  Layer layer;
  for (const MapPoint& point : points) layer.add(point);
  return layer;
}

bool is_thin(float thickness, std::span<const MapPoint> points) {
  const auto [lowest, highest] =
      std::minmax_element(points.begin(), points.end(),
                          [](const MapPoint& a, const MapPoint& b) { return a.height < b.height; });
  return highest->height - lowest->height <= thickness;
}

CellReading reading_of(const MapperConfig& config, const Layer& surface) {
  const float offset =
      std::max(std::abs(surface.sum.offset_x), std::abs(surface.sum.offset_y)) / surface.count;
  const bool centred = offset <= static_cast<float>(config.cell_offset_max);
  return {.kind = centred ? CellReadingKind::surface : CellReadingKind::off_centre,
          .height = surface.sum.height / surface.count};
}

/// How many points tell something.
struct Needed {
  float surface = 0.0F;        ///< For a surface of its own.
  float next_to_riser = 0.0F;  ///< For a surface that is left when a riser's points are taken off.
};

/// The reading of points that are spread in height.
CellReading read_edge(const MapperConfig& config, const Needed& needed,
                      std::span<MapPoint> points) {
  const float thickness = static_cast<float>(config.cluster_height);
  std::sort(points.begin(), points.end(),
            [](const MapPoint& a, const MapPoint& b) { return a.height > b.height; });
  const auto first_below = [&](std::size_t from, float height) {
    while (from < points.size() && points[from].height >= height) ++from;
    return from;
  };
  std::size_t end = 0;
  for (std::size_t start = 0; start < points.size(); ++start) {
    const float top = points[start].height;
    end = first_below(std::max(end, start), top - thickness);
    if (static_cast<float>(end - start) < needed.surface) continue;
    const std::size_t end_below = first_below(end, top - 2.0F * thickness);
    Layer surface = sum_of(points.subspan(start, end - start));
    const Layer below = sum_of(points.subspan(end, end_below - end));
    const bool has_riser = below.count >= needed.surface;
    surface.count -= below.count;
    if (surface.count < (has_riser ? needed.next_to_riser : needed.surface)) {
      return {CellReadingKind::off_centre, top, has_riser};
    }
    surface.sum.height -= below.sum.height + below.count * thickness;
    surface.sum.offset_x -= below.sum.offset_x;
    surface.sum.offset_y -= below.sum.offset_y;
    CellReading reading = reading_of(config, surface);
    reading.has_riser = has_riser;
    return reading;
  }
  return {};
}

}  // namespace

CellReading read_cell(const MapperConfig& config, double expected, std::span<MapPoint> points) {
  const double least = static_cast<double>(config.points_min);
  const Needed needed{
      .surface = static_cast<float>(std::max(least, config.cluster_share * expected)),
      .next_to_riser = static_cast<float>(std::max(least, kHalfCovered * expected))};
  if (static_cast<float>(points.size()) < needed.surface) return {};
  if (!is_thin(static_cast<float>(config.cluster_height), points)) {
    return read_edge(config, needed, points);
  }
  return reading_of(config, sum_of(points));
}

}  // namespace hopscotch::perception
