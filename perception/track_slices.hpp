#pragma once

#include <cstdint>
#include <vector>

#include "core/one_step_terrain.hpp"
#include "core/terrain_map.hpp"
#include "perception/one_step.hpp"

namespace hopscotch::perception {

/// What the two foot tracks find at one distance.
enum class SliceKind : std::uint8_t {
  level,   ///< Ground, observed, one height across.
  broken,  ///< Observed, but no common height: an edge runs through.
  blind,   ///< Below the camera's view, between the stance and ground of the same height.
  hidden,  ///< Not observed, bounded from above.
  unseen,  ///< Not observed, not bounded.
};

/// A thin slice across both foot tracks; heights relative to S.
struct Slice {
  double x = 0.0;  ///< In S [m].
  SliceKind kind = SliceKind::unseen;
  double lower = core::kNaN;  ///< [m]
  double mean = core::kNaN;   ///< [m]
  double upper = core::kNaN;  ///< [m]; infinity when unseen.
  double variance = 0.0;      ///< Of a single cell's height [m^2]; when level or broken.
};

/// Slices per sample of the profile: fine enough that cells of the map do not alias with it.
inline constexpr int kSlicesPerSample = 3;
inline constexpr double kSliceStep = core::TerrainProfile::kStep / kSlicesPerSample;  // [m]

/// A stretch of the jump line; the default is that of the profile.
struct SliceRange {
  double start = core::TerrainProfile::kStart;  ///< First slice, in S [m].
  int count = (core::TerrainProfile::kSamples - 1) * kSlicesPerSample + 1;
};

/// Slices over a stretch; over the profile's the middle one of sample i is slice
/// i * kSlicesPerSample.
[[nodiscard]] std::vector<Slice> cut_slices(const OneStepConfig& config,
                                            const core::TerrainMap& map, const StancePose& stance,
                                            const SliceRange& range = {});

}  // namespace hopscotch::perception
