#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "core/time.hpp"

namespace hopscotch::apps {

/// Where and when an image was taken; V is whatever world the recorder used.
struct CameraPose {
  core::Stamp stamp;
  Eigen::Isometry3d X_VC = Eigen::Isometry3d::Identity();
};

/// The pose of each image, from the one text file in the folder whose name holds "pose": a line per
/// pose, "[stamp] tx ty tz qx qy qz qw". Identity for all, 30 images a second, when there is none.
/// @throws core::ConfigError naming file, line and rule.
[[nodiscard]] std::vector<CameraPose> poses_of_images(
    const std::filesystem::path& folder, const std::vector<std::filesystem::path>& images);

}  // namespace hopscotch::apps
