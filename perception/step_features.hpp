#pragma once

#include <vector>

#include "core/one_step_terrain.hpp"
#include "perception/perception_config.hpp"
#include "perception/track_slices.hpp"

namespace hopscotch::perception {

/// A stretch of connected support along the jump line.
struct Tread {
  double start = 0.0;         ///< In S [m].
  double end = 0.0;           ///< In S [m].
  double start_height = 0.0;  ///< Near its start, in S [m].
  double end_height = 0.0;    ///< Near its end, in S [m].
};

/// Divides the jump line into treads: support without steps. Pit floors and stretches too short for
/// a foot between higher ground are left out; holes shorter than a gap are bridged.
[[nodiscard]] std::vector<Tread> find_treads(const OneStepConfig& config,
                                             const std::vector<Slice>& slices);

/// Edges and gaps between consecutive treads, and the edge behind which nothing is known to bear.
/// An edge of support is where the last cell that bears ends, never interpolated into the gap.
void list_features(const OneStepConfig& config, const std::vector<Slice>& slices,
                   const std::vector<Tread>& treads, core::OneStepTerrain& terrain);

}  // namespace hopscotch::perception
