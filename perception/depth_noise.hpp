#pragma once

#include "perception/perception_config.hpp"

namespace hopscotch::perception {

/// Standard deviation of one depth reading at `depth` [m]: base + quadratic depth^2, the published
/// shape for active stereo cameras.
[[nodiscard]] double depth_sigma(const DepthNoiseConfig& noise, double depth);

/// Where a cell lies as seen from the camera.
struct ViewOfCell {
  double depth = 0.0;       ///< Along the optical axis [m].
  double horizontal = 0.0;  ///< Distance on the ground [m].
  double rise = 0.0;        ///< Height of the cell above the camera; negative below [m].
};

/// Variance of the height that one frame measures for one cell [m^2]. Neighbouring pixels err
/// together (correlation 0.5 at 8 pixels), so all points of a cell in one frame are one reading.
[[nodiscard]] double height_variance(const DepthNoiseConfig& noise, const ViewOfCell& view);

/// Variance that fusing more frames does not reduce [m^2]: pose and calibration errors that all
/// frames share.
[[nodiscard]] double shared_variance(const DepthNoiseConfig& noise, const ViewOfCell& view);

}  // namespace hopscotch::perception
