#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "apps/depth_image_file.hpp"

namespace hopscotch::apps {

/// Options that `hopscotch scene` and `hopscotch replay` share.
struct DepthOptions {
  std::vector<double> intrinsics;  ///< fx, fy, cx, cy [pixel]; empty: as DepthScaling says.
  double metres_per_unit = 0.001;  ///< [m]

  [[nodiscard]] DepthScaling scaling() const;
};

void add_depth_options(CLI::App& command, DepthOptions& options);

}  // namespace hopscotch::apps
