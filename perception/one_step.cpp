#include "perception/one_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "model/kinematics.hpp"
#include "perception/edge_lines.hpp"
#include "perception/step_features.hpp"
#include "perception/track_slices.hpp"

namespace hopscotch::perception {

namespace {

using core::CellState;
using core::TerrainProfile;

CellState state_of(SliceKind kind) {
  switch (kind) {
    case SliceKind::level:
    case SliceKind::broken: return CellState::observed;
    case SliceKind::blind:
    case SliceKind::hidden: return CellState::occluded;
    case SliceKind::unseen: return CellState::never_seen;
  }
  return CellState::never_seen;
}

/// A sample stands for the slices around it: its bounds hold for all of them, its mean is the
/// middle one's.
TerrainProfile profile_of(const std::vector<Slice>& slices) {
  TerrainProfile profile;
  const int last = static_cast<int>(slices.size()) - 1;
  for (int i = 0; i < TerrainProfile::kSamples; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const int middle = i * kSlicesPerSample;
    const Slice& centre = slices[static_cast<std::size_t>(middle)];
    profile.state[k] = state_of(centre.kind);
    profile.mean[k] = centre.mean;
    profile.lower[k] = centre.lower;
    profile.upper[k] = centre.upper;
    for (int j = std::max(0, middle - 1); j <= std::min(last, middle + 1); ++j) {
      const Slice& slice = slices[static_cast<std::size_t>(j)];
      // A neighbour of unknown height bounds nothing: NaN loses each comparison.
      if (slice.lower < profile.lower[k]) profile.lower[k] = slice.lower;
      if (slice.upper > profile.upper[k]) profile.upper[k] = slice.upper;
    }
    if (profile.state[k] == CellState::observed && !std::isfinite(profile.upper[k])) {
      profile.upper[k] = centre.upper;
    }
  }
  return profile;
}

double coverage_ahead(const std::vector<Slice>& slices) {
  int ahead = 0;
  int observed = 0;
  for (const Slice& slice : slices) {
    if (slice.x < 0.0) continue;
    ++ahead;
    observed += state_of(slice.kind) == CellState::observed ? 1 : 0;
  }
  return static_cast<double>(observed) / static_cast<double>(ahead);
}

}  // namespace

StancePose stance_pose(const OneStepConfig& config, const model::RobotParameters& robot,
                       const core::RobotState& state) {
  const std::array<Eigen::Isometry3d, core::kLegs> X_WF = model::sole_poses(robot, state);
  const Eigen::Vector3d left = X_WF[core::index(core::Leg::left)].translation();
  const Eigen::Vector3d right = X_WF[core::index(core::Leg::right)].translation();
  const Eigen::Vector3d ahead = X_WF[0].linear().col(0) + X_WF[1].linear().col(0);
  StancePose stance;
  stance.p_WS = 0.5 * (left + right);
  stance.heading = std::atan2(ahead.y(), ahead.x());
  stance.half_stance = 0.5 * (left - right).head<2>().norm();
  stance.track_half_width = 0.5 * robot.foot_width + config.track_margin;
  return stance;
}

core::OneStepTerrain one_step_terrain(const OneStepConfig& config, const core::TerrainMap& map,
                                      const StancePose& stance) {
  const std::vector<Slice> slices = cut_slices(config, map, stance);
  core::OneStepTerrain terrain;
  terrain.stamp = map.stamp;
  terrain.p_WS = stance.p_WS;
  terrain.heading = stance.heading;
  terrain.profile = profile_of(slices);
  DividedLine line{.treads = find_treads(config, slices), .breaks = {}};
  line.breaks = find_breaks(map, stance, line.treads);
  static_cast<void>(list_features(config, slices, line, terrain));
  terrain.coverage = coverage_ahead(slices);
  return terrain;
}

}  // namespace hopscotch::perception
