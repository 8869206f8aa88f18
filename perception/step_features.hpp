#pragma once

#include <vector>

#include "core/one_step_terrain.hpp"
#include "perception/perception_config.hpp"
#include "perception/track_slices.hpp"
#include "perception/tread.hpp"

namespace hopscotch::perception {

/// Divides the jump line into treads: support without steps. Pit floors and stretches too short for
/// a foot between higher ground are left out; holes shorter than a gap are bridged.
[[nodiscard]] std::vector<Tread> find_treads(const OneStepConfig& config,
                                             const std::vector<Slice>& slices);

/// Edges and gaps between consecutive treads, and the edge behind which nothing is known to bear.
/// Ends of support are the straight lines of `line.breaks`, or else where slices end; never
/// interpolated into a gap.
/// @return the standard deviation of the step of each edge listed [m].
[[nodiscard]] std::vector<double> list_features(const OneStepConfig& config,
                                                const std::vector<Slice>& slices,
                                                const DividedLine& line,
                                                core::OneStepTerrain& terrain);

}  // namespace hopscotch::perception
