#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/depth_frame.hpp"

namespace hopscotch::apps {

/// A depth image as it stands in a file.
struct RawDepthImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> values;  ///< Row by row; 0 = no measurement.
};

/// How the numbers of a depth image become metres and rays.
struct DepthScaling {
  /// fx, fy, cx, cy [pixel]; nothing: those of common cameras of that size.
  std::optional<std::array<double, 4>> intrinsics;
  double metres_per_unit = 0.001;  ///< [m]
};

/// Whether a file starts like a PNG, a binary PGM or a TIFF.
[[nodiscard]] bool is_image_file(const std::filesystem::path& file);

/// Reads a 16-bit, one-channel PNG, PGM or TIFF.
/// @throws core::ConfigError naming the file and what is wrong: no file, cut short, another format.
[[nodiscard]] RawDepthImage read_depth_image(const std::filesystem::path& file);

/// Depth in metres with the camera's model; stamp and mounting pose are left as they start.
/// @throws core::ConfigError for intrinsics that cannot belong to the image, for an image without a
///         reading, and for a scale that puts the scene millimetres or kilometres away.
[[nodiscard]] core::DepthFrame depth_frame_of(const std::filesystem::path& file,
                                              const RawDepthImage& image,
                                              const DepthScaling& scaling);

}  // namespace hopscotch::apps
