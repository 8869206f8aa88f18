#include "planner/smooth_terrain.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hopscotch::planner {

namespace {

using core::TerrainProfile;
using Samples = std::array<double, static_cast<std::size_t>(TerrainProfile::kSamples)>;

std::size_t clamped(int sample) {
  return static_cast<std::size_t>(std::clamp(sample, 0, TerrainProfile::kSamples - 1));
}

/// In samples from the first one.
double place_of(double x) {
  return std::clamp((x - TerrainProfile::kStart) / TerrainProfile::kStep, 0.0,
                    static_cast<double>(TerrainProfile::kSamples - 1));
}

/// The sample that the spline's piece at a place begins with.
int span_of(double place) {
  return std::min(static_cast<int>(place), TerrainProfile::kSamples - 2);
}

/// A B-spline looks two samples to each side, so the ground of a sole is levelled so far.
void level(const SolePlace& place, Samples& control) {
  for (int i = 0; i < TerrainProfile::kSamples; ++i) {
    const double x = TerrainProfile::x(i);
    const double reach = 2.0 * TerrainProfile::kStep;
    if (x > place.rear - reach && x < place.front + reach) {
      control[clamped(i)] = std::min(control[clamped(i)], place.height);
    }
  }
}

/// Samples outside the jump may be unknown: they take the nearest known height.
void extend(int first, int last, Samples& control) {
  for (int i = 0; i < first; ++i) {
    if (!std::isfinite(control[clamped(i)])) control[clamped(i)] = control[clamped(first)];
  }
  for (int i = last + 1; i < TerrainProfile::kSamples; ++i) {
    if (!std::isfinite(control[clamped(i)])) control[clamped(i)] = control[clamped(last)];
  }
}

}  // namespace

core::Result<SmoothTerrain> SmoothTerrain::from_profile(const TerrainProfile& profile,
                                                        const SolePlace& start,
                                                        const SolePlace& target) {
  const int first = TerrainProfile::sample(std::min(start.rear, target.rear));
  const int last = TerrainProfile::sample(std::max(start.front, target.front));
  Samples upper = profile.upper;
  for (int i = first; i <= last; ++i) {
    if (std::isfinite(upper[clamped(i)])) continue;
    char text[96];
    std::snprintf(text, sizeof text, "terrain height at x = %.3f m is not known",
                  TerrainProfile::x(i));
    return core::Refusal{core::Reason::target_malformed, text};
  }
  extend(first, last, upper);
  Samples control{};
  for (int i = 0; i < TerrainProfile::kSamples; ++i) {
    control[clamped(i)] =
        std::max({upper[clamped(i - 1)], upper[clamped(i)], upper[clamped(i + 1)]});
  }
  level(start, control);
  level(target, control);
  return SmoothTerrain(control);
}

TerrainPoint SmoothTerrain::at(double x) const {
  const double place = place_of(x);
  const int i = span_of(place);
  const double u = place - i;
  const double p0 = control_[clamped(i - 1)];
  const double p1 = control_[clamped(i)];
  const double p2 = control_[clamped(i + 1)];
  const double p3 = control_[clamped(i + 2)];
  const double r = 1.0 - u;
  const double h = TerrainProfile::kStep;
  TerrainPoint point;
  point.height = (r * r * r * p0 + (3.0 * u * u * u - 6.0 * u * u + 4.0) * p1 +
                  (3.0 * r * r * r - 6.0 * r * r + 4.0) * p2 + u * u * u * p3) /
                 6.0;
  point.slope =
      (-r * r * p0 + (3.0 * u * u - 4.0 * u) * p1 + (4.0 * r - 3.0 * r * r) * p2 + u * u * p3) /
      (2.0 * h);
  point.curvature = (r * p0 + (3.0 * u - 2.0) * p1 + (3.0 * r - 2.0) * p2 + u * p3) / (h * h);
  return point;
}

double SmoothTerrain::height_bound(double from, double to) const {
  const std::size_t first = clamped(span_of(place_of(from)) - 1);
  const std::size_t last = clamped(span_of(place_of(to)) + 2);
  return *std::max_element(control_.begin() + static_cast<std::ptrdiff_t>(first),
                           control_.begin() + static_cast<std::ptrdiff_t>(last) + 1);
}

}  // namespace hopscotch::planner
