#pragma once

#include <optional>

#include "core/depth_frame.hpp"

namespace hopscotch::core {

/// A depth camera: simulated, real or recorded.
class DepthSource {
 public:
  virtual ~DepthSource() = default;
  /// The next frame that has arrived by `now`, oldest first; nothing when there is none.
  virtual std::optional<DepthFrame> poll(Stamp now) = 0;
};

}  // namespace hopscotch::core
