#include "footstep/foothold_score.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace hopscotch::footstep {

namespace {

using core::CellState;
using core::Reason;
using core::TerrainCell;

/// A third of a cell: no cell along a line is left out, edges are found to within it [m].
constexpr double kAlongStep = 0.005;
/// Window over which heights on either side of a small step are averaged: 3 cm.
constexpr std::size_t kWindow = 6;
/// Small steps are looked for up to here beyond the tips of the feet [m].
constexpr double kStepGuard = 0.02;
/// Higher steps end the tread and are found as its edges [m].
constexpr double kStepSearch = 0.03;
/// Lines along each foot: left rim, centre, right rim.
constexpr int kLinesPerFoot = 3;

/// The six lines along the feet on which ground is looked up.
class FootLines {
 public:
  FootLines(const StanceOnMap& stance, const FootholdConfig& config, const Placement& placement)
      : map_(stance.map), base_height_(stance.p_WS.z()) {
    const Eigen::Rotation2Dd in_W(stance.heading);
    const Eigen::Rotation2Dd of_feet(stance.heading + placement.yaw);
    const Eigen::Vector2d left = of_feet * Eigen::Vector2d::UnitY();
    const Eigen::Vector2d corner(map_.origin_x, map_.origin_y);
    const Eigen::Vector2d centre =
        stance.p_WS.head<2>() + in_W * Eigen::Vector2d(placement.x, placement.y) - corner;
    const double rim = stance.half_width + config.lateral_margin;
    ahead_ = of_feet * Eigen::Vector2d::UnitX() / map_.resolution;
    std::size_t next = 0;
    for (const double foot : {stance.half_stance, -stance.half_stance}) {
      for (int line = 0; line < kLinesPerFoot; ++line) {
        offsets_[next] = foot + (line - 1) * rim;
        starts_[next] = (centre + offsets_[next] * left) / map_.resolution;
        ++next;
      }
    }
  }

  static constexpr std::size_t size() { return kLinesPerFoot * core::kLegs; }
  /// To the left of the mid-point [m].
  [[nodiscard]] double offset(std::size_t line) const { return offsets_[line]; }
  /// Cell at `along` [m] ahead of the feet's centres; null outside the map.
  [[nodiscard]] const TerrainCell* cell(std::size_t line, double along) const {
    const double x = starts_[line].x() + along * ahead_.x();
    const double y = starts_[line].y() + along * ahead_.y();
    if (!(x >= 0.0 && y >= 0.0 && x < map_.size_x && y < map_.size_y)) return nullptr;
    return &map_.at(static_cast<int>(x), static_cast<int>(y));
  }
  /// Height of a cell in S [m].
  [[nodiscard]] double height(const TerrainCell& cell) const { return cell.height - base_height_; }

 private:
  const core::TerrainMap& map_;
  double base_height_;
  Eigen::Vector2d ahead_ = Eigen::Vector2d::Zero();  // [cells per m]
  std::array<Eigen::Vector2d, kLinesPerFoot * core::kLegs>
      starts_{};  // from the map's corner [cells]
  std::array<double, kLinesPerFoot * core::kLegs> offsets_{};
};

/// Height of the ground at one place under the feet.
struct GroundSample {
  double along = 0.0;   ///< [m]
  double offset = 0.0;  ///< [m]
  double height = 0.0;  ///< In S [m].
};

/// Ground under the feet as height = plane . (1, along, offset).
struct FittedPlane {
  Reason why = Reason::none;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  double worst_variance = 0.0;  ///< [m^2]
  std::vector<GroundSample> samples;

  [[nodiscard]] double height(double along, double offset) const {
    return plane(0) + plane(1) * along + plane(2) * offset;
  }
};

/// Looks up the ground under the feet; `why` says so if any of it is not observed.
FittedPlane sample_ground(const FootLines& lines, double half_length) {
  FittedPlane ground;
  ground.samples.reserve(lines.size() *
                         static_cast<std::size_t>(2.0 * half_length / kAlongStep + 2.0));
  for (std::size_t line = 0; line < lines.size(); ++line) {
    for (double along = -half_length; along <= half_length; along += kAlongStep) {
      const TerrainCell* cell = lines.cell(line, along);
      if (cell == nullptr || cell->state == CellState::never_seen) {
        ground.why = Reason::terrain_unseen;
        return ground;
      }
      // Go on: an unseen cell further on is the stronger reason.
      if (cell->state == CellState::occluded) ground.why = Reason::no_safe_target;
      ground.samples.push_back({along, lines.offset(line), lines.height(*cell)});
      ground.worst_variance = std::max(ground.worst_variance, static_cast<double>(cell->variance));
    }
  }
  return ground;
}

FittedPlane fit_plane(const FootLines& lines, double half_length) {
  FittedPlane fit = sample_ground(lines, half_length);
  if (fit.why != Reason::none) return fit;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const GroundSample& sample : fit.samples) {
    const Eigen::Vector3d row(1.0, sample.along, sample.offset);
    normal += row * row.transpose();
    right += row * sample.height;
  }
  fit.plane = normal.ldlt().solve(right);
  return fit;
}

/// Share of the places under the feet that keep to the plane.
double flat_share(const FittedPlane& fit, double tolerance) {
  const auto keeps = [&](const GroundSample& sample) {
    return std::abs(sample.height - fit.height(sample.along, sample.offset)) <= tolerance;
  };
  const auto flat = std::count_if(fit.samples.begin(), fit.samples.end(), keeps);
  return static_cast<double>(flat) / static_cast<double>(fit.samples.size());
}

/// How far the tread goes on from the foot's tips; `direction` is 1 ahead, -1 behind.
double margin_along(const FootLines& lines, const FittedPlane& fit, double half_length,
                    double tolerance, double direction) {
  double margin = kMarginSearch;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    for (double beyond = 0.0; beyond < margin; beyond += kAlongStep) {
      const double along = direction * (half_length + beyond);
      const TerrainCell* cell = lines.cell(line, along);
      const bool bears =
          cell != nullptr && cell->state == CellState::observed &&
          std::abs(lines.height(*cell) - fit.height(along, lines.offset(line))) <= tolerance;
      if (bears) continue;
      margin = std::max(0.0, beyond - 0.5 * kAlongStep);
      break;
    }
  }
  return margin;
}

/// Whether ground behind the feet rises to where the knees will be.
bool hits_knees(const FootholdConfig& config, const FootLines& lines, const FittedPlane& fit,
                double half_length) {
  for (std::size_t line = 0; line < lines.size(); ++line) {
    for (double behind = half_length; behind < config.knee_room; behind += kAlongStep) {
      const TerrainCell* cell = lines.cell(line, -behind);
      if (cell == nullptr || cell->state != CellState::observed) continue;
      if (lines.height(*cell) > fit.plane(0) + config.knee_rise) return true;
    }
  }
  return false;
}

/// Running sums of the heights below one foot, so that the mean over any window is one difference.
struct RunningHeights {
  std::vector<double> sum{0.0};
  std::vector<int> known{0};

  void add(double heights, int count) {
    sum.push_back(sum.back() + heights);
    known.push_back(known.back() + count);
  }
  /// Mean over [from, to); nothing where half of it is unknown.
  [[nodiscard]] std::optional<double> mean(std::size_t from, std::size_t to) const {
    const int count = known[to] - known[from];
    if (2 * count < static_cast<int>(to - from) * kLinesPerFoot) return std::nullopt;
    return (sum[to] - sum[from]) / count;
  }
};

/// Heights along one foot, with the slope across it taken out; cells beyond an edge are left out.
RunningHeights running_heights(const FootLines& lines, const FittedPlane& fit, std::size_t foot,
                               double reach) {
  RunningHeights heights;
  for (double along = -reach; along <= reach; along += kAlongStep) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t line = foot * kLinesPerFoot; line < (foot + 1) * kLinesPerFoot; ++line) {
      const TerrainCell* cell = lines.cell(line, along);
      if (cell == nullptr || cell->state != CellState::observed) continue;
      const double height = lines.height(*cell);
      if (std::abs(height - fit.height(along, lines.offset(line))) > kStepSearch) continue;
      sum += height - fit.plane(2) * lines.offset(line);
      ++count;
    }
    heights.add(sum, count);
  }
  return heights;
}

/// Whether a step runs below a foot or right beside its tips that is too low to end the tread: a
/// plane through both sides of it would pass for a slope. Means on either side of each place are
/// compared, so that the noise of single cells does not count.
bool stands_on_step(const FootholdConfig& config, const FootLines& lines, const FittedPlane& fit,
                    double half_length) {
  const double reach = half_length + kStepGuard + kWindow * kAlongStep;
  for (std::size_t foot = 0; foot < core::kLegs; ++foot) {
    const RunningHeights heights = running_heights(lines, fit, foot, reach);
    for (std::size_t i = kWindow; i + kWindow < heights.sum.size(); ++i) {
      const std::optional<double> before = heights.mean(i - kWindow, i);
      const std::optional<double> behind = heights.mean(i, i + kWindow);
      if (before && behind && std::abs(*behind - *before) > config.step_tolerance) return true;
    }
  }
  return false;
}

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

Reason verdict(const FootholdConfig& config, const Foothold& foothold) {
  if (foothold.toe_margin + foothold.heel_margin < 2.0 * config.margin_min) {
    return Reason::tread_too_short;
  }
  if (foothold.margin() < config.margin_min) return Reason::no_safe_target;
  if (foothold.safe_probability < config.probability_min) return Reason::no_safe_target;
  return Reason::none;
}

}  // namespace

double safe_probability(double toe_margin, double heel_margin, double sigma) {
  const double kept = normal_cdf(toe_margin / sigma) + normal_cdf(heel_margin / sigma) - 1.0;
  return std::max(0.0, kept);
}

Foothold score_foothold(const FootholdConfig& config, const StanceOnMap& stance,
                        const Placement& placement) {
  Foothold foothold;
  foothold.placement = placement;
  const FootLines lines(stance, config, placement);
  const FittedPlane fit = fit_plane(lines, stance.half_length);
  foothold.why = fit.why;
  if (fit.why != Reason::none) return foothold;

  foothold.height = fit.plane(0);
  foothold.rise_across = fit.plane(2);
  const bool level = std::abs(fit.plane(1)) <= std::tan(config.slope_max) &&
                     std::abs(fit.plane(2)) <= std::tan(config.cross_slope_max);
  const bool known = std::sqrt(fit.worst_variance) <= config.height_sigma_max;
  const double flat = flat_share(fit, config.flat_tolerance);
  if (!level || !known || flat < config.flat_share) {
    foothold.why = known ? Reason::no_safe_target : Reason::terrain_unseen;
    return foothold;
  }
  foothold.supported = true;
  foothold.toe_margin = margin_along(lines, fit, stance.half_length, config.edge_tolerance, 1.0);
  foothold.heel_margin = margin_along(lines, fit, stance.half_length, config.edge_tolerance, -1.0);
  foothold.safe_probability = safe_probability(foothold.toe_margin, foothold.heel_margin,
                                               std::hypot(config.edge_sigma, config.landing_sigma));
  foothold.why = verdict(config, foothold);
  const bool room = foothold.heel_margin >= config.knee_room - stance.half_length;
  if (foothold.why == Reason::none && !room && hits_knees(config, lines, fit, stance.half_length)) {
    foothold.why = Reason::no_safe_target;
  }
  if (foothold.why == Reason::none && stands_on_step(config, lines, fit, stance.half_length)) {
    foothold.why = Reason::no_safe_target;
  }
  return foothold;
}

}  // namespace hopscotch::footstep
