#pragma once

#include <array>

#include "core/one_step_terrain.hpp"
#include "core/result.hpp"
#include "planner/differentiation.hpp"

namespace hopscotch::planner {

/// Height of a function and its first two derivatives.
struct TerrainPoint {
  double height = 0.0;     ///< [m]
  double slope = 0.0;      ///< [m/m]
  double curvature = 0.0;  ///< [1/m]
};

/// Stretch of ground that a sole stands on, in S.
struct SolePlace {
  double rear = 0.0;    ///< Heel [m].
  double front = 0.0;   ///< Toe [m].
  double height = 0.0;  ///< [m]
};

/// Twice differentiable upper bound of the terrain along the jump: a uniform cubic B-spline over
/// the profile's `upper` samples, each first raised to its highest neighbour, so that the slopes
/// of a step lie on its low side. Where a sole stands or is to stand nothing rises above it.
class SmoothTerrain {
 public:
  /// Between two samples an edge can be anywhere, so that the spline may begin to fall before the
  /// ground does. What passes close by an edge behind it looks so much further back [m].
  static constexpr double kEdgeDoubt = 0.020;

  /// @return target_malformed if `upper` is not finite anywhere between the places.
  static core::Result<SmoothTerrain> from_profile(const core::TerrainProfile& profile,
                                                  const SolePlace& start, const SolePlace& target);

  /// Constant beyond the ends of the profile.
  [[nodiscard]] TerrainPoint at(double x) const;

  /// Nothing between these places is higher than this: the spline stays below its control points.
  [[nodiscard]] double height_bound(double from, double to) const;

  template <typename T>
  [[nodiscard]] T height(const T& x) const {
    const TerrainPoint point = at(value_of(x));
    return compose(x, point.height, point.slope, point.curvature);
  }

 private:
  explicit SmoothTerrain(
      const std::array<double, static_cast<std::size_t>(core::TerrainProfile::kSamples)>& control)
      : control_(control) {}
  std::array<double, static_cast<std::size_t>(core::TerrainProfile::kSamples)> control_;
};

}  // namespace hopscotch::planner
