#pragma once

#include <Eigen/Geometry>
#include <filesystem>

#include "apps/terrain_json.hpp"
#include "core/depth_frame.hpp"
#include "core/terrain_map.hpp"

namespace hopscotch::apps {

/// Draws the map from above, half metres ahead of the soles at its left: height above them by
/// colour, hidden ground dark grey, unseen ground black, edges across the foot tracks with kind and
/// step, ranked targets as soles (the chosen one white, with its distance and probability),
/// rejected places as crosses, a reason at the first of its places.
/// @throws std::runtime_error naming the file if it cannot be written.
void draw_map(const std::filesystem::path& file, const core::TerrainMap& map,
              const TerrainReport& report);

/// Draws the same edges, targets and rejected places over the depth image.
/// @param X_WC  Pose of the camera.
void draw_over_depth(const std::filesystem::path& file, const core::DepthFrame& frame,
                     const Eigen::Isometry3d& X_WC, const TerrainReport& report);

}  // namespace hopscotch::apps
