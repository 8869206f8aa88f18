#pragma once

#include <Eigen/Core>

#include "core/one_step_terrain.hpp"
#include "core/robot_state.hpp"
#include "core/terrain_map.hpp"
#include "model/robot_parameters.hpp"
#include "perception/perception_config.hpp"

namespace hopscotch::perception {

/// Frame S of a stance and the tracks that its feet would follow.
struct StancePose {
  Eigen::Vector3d p_WS = Eigen::Vector3d::Constant(core::kNaN);  ///< Mid-point of the soles [m].
  double heading = core::kNaN;           ///< Yaw of the mean sole direction in W [rad].
  double half_stance = core::kNaN;       ///< Soles lie so far left and right of S [m].
  double track_half_width = core::kNaN;  ///< Half of a foot's width with its margin [m].
};

/// The stance of a robot with both soles on the ground.
[[nodiscard]] StancePose stance_pose(const OneStepConfig& config,
                                     const model::RobotParameters& robot,
                                     const core::RobotState& state);

/// Cuts the map along the jump line and lists what the next jump meets: the profile over both foot
/// tracks, edges, gaps, coverage. Nothing is invented: unobserved samples have NaN for `lower` and
/// `mean`, and `upper` is what rays prove, infinity where there were none. The one exception is the
/// strip between the soles and the first visible ground: when both are level it is `occluded` with
/// that height as its bound, good to fly over, not to land on.
/// @param stance  Finite; heights in the result are relative to its p_WS.
[[nodiscard]] core::OneStepTerrain one_step_terrain(const OneStepConfig& config,
                                                    const core::TerrainMap& map,
                                                    const StancePose& stance);

}  // namespace hopscotch::perception
