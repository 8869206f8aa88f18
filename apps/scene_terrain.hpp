#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

#include "apps/depth_image_file.hpp"
#include "apps/program_config.hpp"
#include "apps/terrain_json.hpp"
#include "core/depth_frame.hpp"
#include "core/terrain_map.hpp"
#include "model/robot_parameters.hpp"
#include "perception/ground_frame.hpp"
#include "perception/point_cloud.hpp"

namespace hopscotch::apps {

/// One recording and what its user says about it.
struct SceneRequest {
  std::filesystem::path file;
  DepthScaling scaling;  ///< Of images.
  perception::GroundHints hints;
};

/// A recording in memory; images also as the frame they are.
struct SceneRecording {
  perception::PointCloud cloud;
  std::optional<core::DepthFrame> frame;
};

/// What was made of a recording.
struct SceneTerrain {
  TerrainReport report;
  core::TerrainMap map;
  Eigen::Isometry3d X_WR = Eigen::Isometry3d::Identity();  ///< Recording's frame in W.
};

/// Reads an image, PCD or PLY file.
/// @throws core::ConfigError naming the file and what is wrong with it.
[[nodiscard]] SceneRecording read_scene(const SceneRequest& request, const ProgramConfig& config);

/// Pixels of an image that can be trusted, as points in C.
[[nodiscard]] perception::PointCloud cloud_of(const core::DepthFrame& frame,
                                              const perception::PerceptionConfig& config);

/// HECTOR standing with the mid-point of its soles at the origin of S: `X_WS` is upright.
/// @throws core::ConfigError if the configured posture cannot be taken.
[[nodiscard]] core::RobotState standing_at(const ProgramConfig& config,
                                           const model::RobotParameters& robot,
                                           const Eigen::Isometry3d& X_WS);

/// Finds ground, treads, edges and targets in a recording.
/// @throws core::ConfigError if no ground can be found and no pose was given.
[[nodiscard]] SceneTerrain look_at_scene(const SceneRequest& request,
                                         const SceneRecording& recording,
                                         const ProgramConfig& config,
                                         const model::RobotParameters& robot);

}  // namespace hopscotch::apps
