#pragma once

#include <memory>
#include <vector>

#include "core/depth_frame.hpp"
#include "perception/body_mask.hpp"
#include "perception/perception_config.hpp"

namespace hopscotch::perception {

/// What became of the pixels of one frame.
struct FilterCounts {
  int measured = 0;  ///< Finite and positive on arrival.
  int kept = 0;      ///< Still there at the end.
};

/// Keeps the pixels that can be trusted: within range, not at a depth edge (where stereo and optics
/// mix near and far into readings of neither), not the robot's own body. Fills no holes: an
/// invented pixel would become ground.
class DepthFilter {
 public:
  DepthFilter(const DepthFilterConfig& config, const DepthNoiseConfig& noise);
  ~DepthFilter();

  /// @param frame       Of the size that its intrinsics state; any depth value is allowed.
  /// @param body        In C.
  /// @param[out] depth  Row by row [m]; 0 = removed or never measured.
  FilterCounts filter(const core::DepthFrame& frame, const BodyCapsules& body,
                      std::vector<float>& depth);

 private:
  struct Images;  // OpenCV stays out of this header
  DepthFilterConfig config_;
  DepthNoiseConfig noise_;
  std::unique_ptr<Images> images_;
};

}  // namespace hopscotch::perception
