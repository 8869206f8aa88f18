#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "core/depth_frame.hpp"

namespace hopscotch::sim {

/// A convex planar quadrilateral in W, visible from both sides; corners in order around it [m].
struct Face {
  std::array<Eigen::Vector3d, 4> corners;
};

/// All points within `radius` of the segment from `a` to `b`, in W [m]; a differs from b.
struct Capsule {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  double radius = 0.0;
};

/// Distances along the optical axis that the sensor can measure [m].
struct DepthRange {
  double nearest = 0.20;   ///< A D435 at 640x480 sees nothing closer.
  double farthest = 3.50;  ///< Beyond, its noise exceeds any step of interest.
};

/// Part of one image row [pixel].
struct ColumnSpan {
  double left;
  double right;
};

/// Draws exact depth images: faces by scanlines with perspective-correct inverse depth (affine over
/// the screen on a plane), capsules by a quadratic per pixel of their bounding rectangle. What is
/// nearer than the range still hides what is behind it. Under 1 ms at 640x480 on one core.
class DepthRenderer {
 public:
  /// @pre width and height are positive.
  DepthRenderer(const core::CameraIntrinsics& intrinsics, const DepthRange& range);

  /// @param X_WC  Pose of the camera.
  /// @param[out] depth Resized to width x height: row by row, along z of C [m]; 0 where there is
  ///              nothing within the range.
  void render(std::span<const Face> faces, std::span<const Capsule> capsules,
              const Eigen::Isometry3d& X_WC, std::vector<float>& depth);

  [[nodiscard]] const core::CameraIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  void draw_face(const Face& face, const Eigen::Isometry3d& X_CW);
  void draw_capsule(const Capsule& capsule, const Eigen::Isometry3d& X_CW);
  [[nodiscard]] float* row(int v) {
    return inverse_depth_.data() + static_cast<std::size_t>(v) * ray_x_.size();
  }

  core::CameraIntrinsics intrinsics_;
  DepthRange range_;
  std::vector<float> inverse_depth_;  ///< 1/z, 0 where nothing has been drawn [1/m].
  std::vector<ColumnSpan> spans_;     ///< Of the face being drawn, one per row.
  std::vector<float> ray_x_;          ///< x/z of the ray through each column.
};

}  // namespace hopscotch::sim
