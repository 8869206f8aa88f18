#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/time.hpp"

namespace hopscotch::core {

/// Pinhole model of a depth camera; pixel (u, v) = (fx x/z + cx, fy y/z + cy) in C.
struct CameraIntrinsics {
  int width = 0;    ///< [pixel]
  int height = 0;   ///< [pixel]
  double fx = 0.0;  ///< [pixel]
  double fy = 0.0;  ///< [pixel]
  double cx = 0.0;  ///< [pixel]
  double cy = 0.0;  ///< [pixel]
};

/// One depth image. Frame C: optical centre, z forward, x right, y down.
struct DepthFrame {
  Stamp stamp;  ///< Mid exposure.
  CameraIntrinsics intrinsics;
  Eigen::Isometry3d X_BC = Eigen::Isometry3d::Identity();  ///< Mounting pose on the trunk.
  std::vector<float> depth;  ///< Along z of C, row by row [m]; 0 = no measurement.
};

}  // namespace hopscotch::core
