#pragma once

#include <filesystem>

#include "perception/point_cloud.hpp"

namespace hopscotch::perception {

/// Reads a PCD or PLY file. Header and size are checked before a byte of it is believed, so a
/// truncated or hostile file is an error and not a large allocation. Points at the origin exactly
/// count as not measured: some recorders write them for that.
/// @throws core::ConfigError naming the file and what is wrong with it.
[[nodiscard]] PointCloud read_cloud_file(const std::filesystem::path& file);

}  // namespace hopscotch::perception
