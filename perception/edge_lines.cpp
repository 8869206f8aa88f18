#include "perception/edge_lines.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace hopscotch::perception {

namespace {

constexpr double kLineSpacing = 0.0075;  // across the tracks, finer than a cell [m]
constexpr double kStride = 0.0025;       // along a line [m]
constexpr double kInside = 0.06;         // a search begins so far within the tread [m]
constexpr double kBeyond = 0.06;         // and goes on so far behind the last tread [m]
constexpr double kHoleMax = 0.03;        // a longer stretch without support ends a tread [m]
constexpr double kSameLevel = 0.02;   // cells farther from the tread's height are not its own [m]
constexpr std::size_t kLinesMin = 6;  // fewer are no edge across the tracks

/// One line's answer.
struct LineEnd {
  double y;  ///< Of the line, in S [m].
  double x;  ///< Where support ends on it, in S [m].
};

/// A stretch of the jump line that is searched for the end of a tread.
struct Search {
  double from = 0.0;    ///< Within the tread, in S [m].
  double to = 0.0;      ///< In S [m]; smaller than `from` when the tread's start is looked for.
  double height = 0.0;  ///< Of the tread there, in S [m].
};

class Walk {
 public:
  Walk(const core::TerrainMap& map, const StancePose& stance)
      : map_(map), stance_(stance), ahead_(std::cos(stance.heading), std::sin(stance.heading)) {}

  /// Where support ends on the line at y; nothing when it was not met or does not end.
  [[nodiscard]] std::optional<double> end_on_line(const Search& search, double y) const {
    const double direction = search.to > search.from ? 1.0 : -1.0;
    const int strides = static_cast<int>(std::abs(search.to - search.from) / kStride);
    std::optional<double> last;
    for (int i = 0; i <= strides; ++i) {
      const double x = search.from + direction * i * kStride;
      if (bears(x, y, search.height)) {
        last = x;
      } else if (last && std::abs(x - *last) > kHoleMax) {
        return *last + 0.5 * direction * kStride;
      }
    }
    const bool ended = last && std::abs(search.to - *last) > kStride;
    return ended ? std::optional(*last + 0.5 * direction * kStride) : std::nullopt;
  }

 private:
  [[nodiscard]] bool bears(double x, double y, double height) const {
    const Eigen::Vector2d left(-ahead_.y(), ahead_.x());
    const Eigen::Vector2d p = stance_.p_WS.head<2>() + x * ahead_ + y * left;
    const int ix = static_cast<int>(std::floor((p.x() - map_.origin_x) / map_.resolution));
    const int iy = static_cast<int>(std::floor((p.y() - map_.origin_y) / map_.resolution));
    if (!map_.contains(ix, iy)) return false;
    const core::TerrainCell& cell = map_.at(ix, iy);
    const double level = static_cast<double>(cell.height) - stance_.p_WS.z();
    return cell.state == core::CellState::observed && std::abs(level - height) <= kSameLevel;
  }

  const core::TerrainMap& map_;
  const StancePose& stance_;
  Eigen::Vector2d ahead_;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median of the slopes between all pairs of lines that lie apart: a quarter may be wrong.
double middle_slope(const std::vector<LineEnd>& ends) {
  constexpr double kApart = 0.05;  // of nearer ones the steps of cells are all the slope [m]
  std::vector<double> slopes;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      const double apart = ends[j].y - ends[i].y;
      if (std::abs(apart) >= kApart) slopes.push_back((ends[j].x - ends[i].x) / apart);
    }
  }
  return slopes.empty() ? 0.0 : median(std::move(slopes));
}

/// Least-squares line x = a + b y.
EdgeLine fit(const std::vector<LineEnd>& ends) {
  const double n = static_cast<double>(ends.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (const LineEnd& end : ends) {
    mean_x += end.x / n;
    mean_y += end.y / n;
  }
  double yy = 0.0;
  double xy = 0.0;
  for (const LineEnd& end : ends) {
    yy += (end.y - mean_y) * (end.y - mean_y);
    xy += (end.y - mean_y) * (end.x - mean_x);
  }
  const double slope = yy > 0.0 ? xy / yy : 0.0;
  double squares = 0.0;
  for (const LineEnd& end : ends) {
    const double residual = end.x - mean_x - slope * (end.y - mean_y);
    squares += residual * residual;
  }
  return {
      .x = mean_x - slope * mean_y, .skew = std::atan(slope), .scatter = std::sqrt(squares / n)};
}

std::optional<EdgeLine> line_through(const std::vector<LineEnd>& ends) {
  constexpr double kGateMin = 0.012;  // most of a cell: lines differ by that without being wrong
  constexpr double kGateScatters = 3.0;
  constexpr double kAgreed = 0.66;
  // Beyond these the feet stand before two edges, not before one edge askew.
  constexpr double kSkewMax = 0.5;       // [rad]
  constexpr double kScatterMax = 0.012;  // most of a cell [m]
  if (ends.size() < kLinesMin) return std::nullopt;
  const double slope = middle_slope(ends);
  std::vector<double> offsets;
  offsets.reserve(ends.size());
  for (const LineEnd& end : ends) offsets.push_back(end.x - slope * end.y);
  const double offset = median(offsets);
  for (double& value : offsets) value = std::abs(value - offset);
  const double gate = std::max(kGateMin, kGateScatters * median(offsets));
  std::vector<LineEnd> kept;
  for (const LineEnd& end : ends) {
    if (std::abs(end.x - slope * end.y - offset) <= gate) kept.push_back(end);
  }
  const bool agreed =
      static_cast<double>(kept.size()) >= kAgreed * static_cast<double>(ends.size());
  if (!agreed || kept.size() < kLinesMin) return std::nullopt;
  const EdgeLine line = fit(kept);
  const bool straight = std::abs(line.skew) <= kSkewMax && line.scatter <= kScatterMax;
  return straight ? std::optional(line) : std::nullopt;
}

std::optional<EdgeLine> find(const Walk& walk, const StancePose& stance, const Search& search) {
  std::vector<LineEnd> ends;
  const int half = static_cast<int>(std::lround(stance.track_half_width / kLineSpacing));
  for (const double side : {-stance.half_stance, stance.half_stance}) {
    for (int i = -half; i <= half; ++i) {
      const double y = side + i * kLineSpacing;
      const std::optional<double> x = walk.end_on_line(search, y);
      if (x) ends.push_back({y, *x});
    }
  }
  return line_through(ends);
}

}  // namespace

std::vector<TreadBreak> find_breaks(const core::TerrainMap& map, const StancePose& stance,
                                    const std::vector<Tread>& treads) {
  const Walk walk(map, stance);
  std::vector<TreadBreak> breaks;
  for (std::size_t i = 0; i < treads.size(); ++i) {
    const Tread& before = treads[i];
    const bool last = i + 1 == treads.size();
    const double inside = std::min(kInside, 0.5 * (before.end - before.start));
    TreadBreak found;
    found.end = find(walk, stance,
                     {.from = before.end - inside,
                      .to = last ? before.end + kBeyond : treads[i + 1].start + kInside,
                      .height = before.end_height});
    if (!last) {
      const Tread& behind = treads[i + 1];
      const double within = std::min(kInside, 0.5 * (behind.end - behind.start));
      found.start = find(walk, stance,
                         {.from = behind.start + within,
                          .to = before.end - kInside,
                          .height = behind.start_height});
    }
    breaks.push_back(found);
  }
  return breaks;
}

}  // namespace hopscotch::perception
