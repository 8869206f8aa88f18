#include "footstep/height_doubt.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::footstep {

using core::CellState;
using core::Range;
using core::TerrainProfile;

namespace {

/// Neighbouring samples that differ by less belong to one tread [m]; a slope of 20 deg rises by 5
/// mm between them.
constexpr double kSameTread = 0.010;

bool goes_on(const TerrainProfile& profile, std::size_t from, std::size_t to) {
  return profile.state[to] == CellState::observed &&
         std::abs(profile.mean[to] - profile.mean[from]) <= kSameTread;
}

void lower_by(double height, std::size_t sample, TerrainProfile& profile) {
  // At the foot of a riser the bound is that of the next tread, which is not moved.
  const bool level = profile.upper[sample] - profile.mean[sample] <= kSameTread;
  if (level) profile.upper[sample] -= height;
  profile.mean[sample] -= height;
  profile.lower[sample] -= height;
}

}  // namespace

DoubtConfig DoubtConfig::load(const core::ConfigReader& section) {
  DoubtConfig config;
  config.tolerance = section.number("tolerance_m", Range::not_negative());
  config.gain = section.number("gain", Range::not_negative());
  config.max = section.number("max_m", Range::closed(0.0, 0.2));
  config.keep = section.number("keep", Range::closed(0.0, 1.0));
  section.finish();
  return config;
}

void HeightDoubt::landed(double surprise) {
  if (!std::isfinite(surprise)) return;
  const double beyond = std::max(0.0, std::abs(surprise) - config_.tolerance);
  height_ = std::min(config_.max, std::max(config_.keep * height_, config_.gain * beyond));
}

void put_underfoot(TerrainProfile& profile) {
  const auto here = static_cast<std::size_t>(TerrainProfile::sample(0.0));
  if (profile.state[here] != CellState::observed || !std::isfinite(profile.mean[here])) return;
  std::size_t first = here;
  while (first > 0 && goes_on(profile, first, first - 1)) --first;
  std::size_t last = here;
  while (last + 1 < profile.mean.size() && goes_on(profile, last, last + 1)) ++last;
  const double height = profile.mean[here];
  for (std::size_t i = first; i <= last; ++i) lower_by(height, i, profile);
}

void take_over(const TerrainProfile& other, double begin, TerrainProfile& profile) {
  for (int i = 0; i < TerrainProfile::kSamples; ++i) {
    if (TerrainProfile::x(i) < begin) continue;
    const auto at = static_cast<std::size_t>(i);
    profile.lower[at] = other.lower[at];
    profile.mean[at] = other.mean[at];
    profile.upper[at] = other.upper[at];
    profile.state[at] = other.state[at];
  }
}

void raise(const JumpStretch& stretch, double height, TerrainProfile& profile) {
  for (int i = 0; i < TerrainProfile::kSamples; ++i) {
    const double x = TerrainProfile::x(i);
    if (x >= stretch.begin && x <= stretch.end)
      profile.upper[static_cast<std::size_t>(i)] += height;
  }
}

}  // namespace hopscotch::footstep
