#include "footstep/terrain_profile.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::footstep {

namespace {

using core::CellState;
using core::TerrainProfile;

constexpr std::size_t kSamples = TerrainProfile::kSamples;

// Ground under a sole; a little stricter than what the planner refuses.
constexpr double kUneven = 0.038;     // above or below it [m]
constexpr double kSoleInset = 0.008;  // from toe and heel, where maps blur edges [m]
constexpr double kSoleMiddle = 0.03;  // either side of its centre [m]

struct Stretch {
  std::size_t first = 0;
  std::size_t behind = 0;  ///< One past the last sample.
};

/// Gives the unobserved samples of one stretch their numbers.
void fill(const ProfileConfig& config, const Stretch& stretch, BoundedProfile& result) {
  TerrainProfile& profile = result.profile;
  const bool rim_before = stretch.first > 0;
  const bool rim_behind = stretch.behind < kSamples;
  const std::size_t before = rim_before ? stretch.first - 1 : stretch.behind;
  const std::size_t behind = rim_behind ? stretch.behind : before;
  const bool nothing_known = !rim_before && !rim_behind;
  const double low = nothing_known ? 0.0 : std::min(profile.mean[before], profile.mean[behind]);
  const double rims = nothing_known ? 0.0 : std::max(profile.upper[before], profile.upper[behind]);
  const double length = static_cast<double>(stretch.behind - stretch.first) * TerrainProfile::kStep;
  const bool enclosed = rim_before && rim_behind && length <= config.unknown_length_max;
  const bool rear = !rim_before && rim_behind;  // the robot stands ahead of it
  for (std::size_t i = stretch.first; i < stretch.behind; ++i) {
    const double ray = profile.upper[i];
    const bool ray_known = std::isfinite(ray) && profile.state[i] == CellState::occluded;
    const double assumed = rear ? rims : rims + config.unknown_margin;
    result.bounded[i] = enclosed || rear || ray_known;
    profile.upper[i] = ray_known ? (enclosed ? std::min(ray, assumed) : ray) : assumed;
    profile.mean[i] = low;
    profile.lower[i] = low;
  }
}

}  // namespace

bool BoundedProfile::is_bounded(double from_x, double to_x) const {
  if (to_x > TerrainProfile::x(TerrainProfile::kSamples - 1)) return false;
  const int first = TerrainProfile::sample(from_x);
  const int last = TerrainProfile::sample(to_x);
  return std::all_of(bounded.begin() + first, bounded.begin() + last + 1,
                     [](bool known) { return known; });
}

double BoundedProfile::highest(double from_x, double to_x) const {
  const int first = TerrainProfile::sample(from_x);
  const int last = TerrainProfile::sample(to_x);
  return *std::max_element(profile.upper.begin() + first, profile.upper.begin() + last + 1);
}

bool BoundedProfile::carries(double sole_x, double half_length, double height) const {
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double from_sole = std::abs(TerrainProfile::x(static_cast<int>(i)) - sole_x);
    if (from_sole <= half_length - kSoleInset && profile.upper[i] - height > kUneven) return false;
    if (from_sole <= kSoleMiddle && height - profile.mean[i] > kUneven) return false;
  }
  return true;
}

BoundedProfile bound_profile(const ProfileConfig& config, const TerrainProfile& seen) {
  BoundedProfile result;
  result.profile = seen;
  std::size_t i = 0;
  while (i < kSamples) {
    if (seen.state[i] == CellState::observed) {
      result.bounded[i] = true;
      ++i;
      continue;
    }
    Stretch stretch{i, i};
    while (stretch.behind < kSamples && seen.state[stretch.behind] != CellState::observed) {
      ++stretch.behind;
    }
    fill(config, stretch, result);
    i = stretch.behind;
  }
  return result;
}

}  // namespace hopscotch::footstep
