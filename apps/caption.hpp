#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "sim/scene_renderer.hpp"

namespace hopscotch::apps {

/// The renderer's picture as OpenCV sees it, without copying; channel order red, green, blue.
[[nodiscard]] cv::Mat as_matrix(sim::RgbImage& image);

/// A dark strip with light text in the lower left corner.
void write_caption(cv::Mat& picture, const std::string& text);

}  // namespace hopscotch::apps
