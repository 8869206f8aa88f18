#include "perception/track_slices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hopscotch::perception {

namespace {

using core::CellState;

constexpr double kLateralStep =
    0.0075;  // finer than a cell, so that none within a track is left out
/// A lone wrong cell at either end of the sorted heights does not break a slice.
constexpr std::size_t kOutliers = 1;

const core::TerrainCell* cell_at(const core::TerrainMap& map, const Eigen::Vector2d& p) {
  const double x = (p.x() - map.origin_x) / map.resolution;
  const double y = (p.y() - map.origin_y) / map.resolution;
  if (!(x >= 0.0 && y >= 0.0 && x < map.size_x && y < map.size_y)) return nullptr;
  return &map.at(static_cast<int>(x), static_cast<int>(y));
}

/// Lateral positions in S of the lines that make up both tracks [m].
std::vector<double> track_lines(const StancePose& stance) {
  std::vector<double> lines;
  const int half = static_cast<int>(std::lround(stance.track_half_width / kLateralStep));
  for (const double side : {1.0, -1.0}) {
    for (int i = -half; i <= half; ++i)
      lines.push_back(side * stance.half_stance + i * kLateralStep);
  }
  return lines;
}

struct Crossing {
  std::vector<double> heights;  // of observed cells, relative to S
  double variance_sum = 0.0;    // of observed cells
  double upper_observed = -std::numeric_limits<double>::infinity();
  double upper_hidden = -std::numeric_limits<double>::infinity();
  std::size_t unseen = 0;
};

Crossing cross(const core::TerrainMap& map, const StancePose& stance, double x,
               const std::vector<double>& lines) {
  const Eigen::Vector2d ahead(std::cos(stance.heading), std::sin(stance.heading));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const Eigen::Vector2d base = stance.p_WS.head<2>() + x * ahead;
  Crossing crossing;
  for (const double y : lines) {
    const core::TerrainCell* cell = cell_at(map, base + y * left);
    if (cell == nullptr || cell->state == CellState::never_seen) {
      ++crossing.unseen;
      continue;
    }
    const double upper = cell->upper - stance.p_WS.z();
    if (cell->state == CellState::observed) {
      crossing.heights.push_back(cell->height - stance.p_WS.z());
      crossing.variance_sum += static_cast<double>(cell->variance);
      crossing.upper_observed = std::max(crossing.upper_observed, upper);
    } else {
      crossing.upper_hidden = std::max(crossing.upper_hidden, upper);
    }
  }
  return crossing;
}

Slice judge(const OneStepConfig& config, double x, std::size_t lines, Crossing& crossing) {
  Slice slice;
  slice.x = x;
  std::vector<double>& heights = crossing.heights;
  const double share = static_cast<double>(heights.size()) / static_cast<double>(lines);
  if (share < config.support_share) {
    slice.kind = crossing.unseen > 0 ? SliceKind::unseen : SliceKind::hidden;
    slice.upper = crossing.unseen > 0 ? std::numeric_limits<double>::infinity()
                                      : std::max(crossing.upper_observed, crossing.upper_hidden);
    return slice;
  }
  std::sort(heights.begin(), heights.end());
  double sum = 0.0;
  for (const double height : heights) sum += height;
  slice.lower = heights.front();
  slice.mean = sum / static_cast<double>(heights.size());
  slice.variance = crossing.variance_sum / static_cast<double>(heights.size());
  // A ray that passed high over a single hidden cell must not lift a slice of observed ground.
  slice.upper = crossing.upper_observed;
  const std::size_t drop = heights.size() > 4 * kOutliers ? kOutliers : 0;
  const double spread = heights[heights.size() - 1 - drop] - heights[drop];
  slice.kind = spread <= config.step_min ? SliceKind::level : SliceKind::broken;
  return slice;
}

/// Turns the strip that no camera pose could see, between the soles and the first visible ground
/// of the same height, into `blind`: nothing is known to stick out there, nothing is known to bear.
void mark_blind_strip(const OneStepConfig& config, std::vector<Slice>& slices) {
  const auto at_feet = std::find_if(slices.begin(), slices.end(),
                                    [](const Slice& slice) { return slice.x > -0.5 * kSliceStep; });
  if (at_feet == slices.end()) return;
  const std::size_t origin = static_cast<std::size_t>(at_feet - slices.begin());
  std::size_t before = origin;
  while (before + 1 < slices.size() && slices[before + 1].kind == SliceKind::level) ++before;
  if (slices[before].kind != SliceKind::level) return;
  std::size_t behind = before + 1;
  std::size_t unseen = 0;
  for (; behind < slices.size() && slices[behind].kind != SliceKind::level; ++behind) {
    if (slices[behind].kind == SliceKind::unseen) ++unseen;
  }
  if (behind >= slices.size()) return;
  const double length = slices[behind].x - slices[before].x;
  const double step = slices[behind].mean - slices[before].mean;
  // Where most of the strip was crossed by rays, it is a gap that was seen, not a blind strip.
  const bool mostly_unseen = 2 * unseen >= behind - before - 1;
  if (length > config.blind_length || std::abs(step) > config.level_tolerance || !mostly_unseen) {
    return;
  }
  const double upper = std::max(slices[before].upper, slices[behind].upper);
  for (std::size_t i = before + 1; i < behind; ++i) {
    slices[i].kind = SliceKind::blind;
    slices[i].upper = upper;
  }
}

}  // namespace

std::vector<Slice> cut_slices(const OneStepConfig& config, const core::TerrainMap& map,
                              const StancePose& stance, const SliceRange& range) {
  const std::vector<double> lines = track_lines(stance);
  std::vector<Slice> slices;
  slices.reserve(static_cast<std::size_t>(range.count));
  for (int i = 0; i < range.count; ++i) {
    const double x = range.start + i * kSliceStep;
    Crossing crossing = cross(map, stance, x, lines);
    slices.push_back(judge(config, x, lines.size(), crossing));
  }
  mark_blind_strip(config, slices);
  return slices;
}

}  // namespace hopscotch::perception
