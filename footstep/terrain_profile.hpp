#pragma once

#include <array>

#include "core/one_step_terrain.hpp"
#include "footstep/footstep_config.hpp"

namespace hopscotch::footstep {

/// The profile as the planner may use it: all numbers finite.
struct BoundedProfile {
  core::TerrainProfile profile;
  /// Whether `upper` of a sample is a bound to rely on. Otherwise it is only a continuation of the
  /// ground before it, and no jump may lead over the sample.
  std::array<bool, core::TerrainProfile::kSamples> bounded{};

  /// Whether all samples between two places in S [m] may be flown over.
  [[nodiscard]] bool is_bounded(double from_x, double to_x) const;
  /// Highest bound between two places in S [m].
  [[nodiscard]] double highest(double from_x, double to_x) const;
  /// Whether a sole on ground of this height [m] would stand on it: nothing rises under it but what
  /// toe and heel blur, and its middle does not hang over something lower. Few cells that stick out
  /// do not turn the plane that the soles are fitted to, and yet no plan may put a foot into them.
  [[nodiscard]] bool carries(double sole_x, double half_length, double height) const;
};

/// Fills what was not observed. Between two observed rims the ground is taken to rise no higher
/// than the higher rim plus a margin, or than a ray that passed over it. Behind the robot it
/// continues level; ahead of the last observed sample only rays bound it. `lower` and `mean` of
/// unobserved samples continue the lower rim, for drawing only.
[[nodiscard]] BoundedProfile bound_profile(const ProfileConfig& config,
                                           const core::TerrainProfile& seen);

}  // namespace hopscotch::footstep
