#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "perception/plane_segmentation.hpp"

namespace hopscotch::perception {

/// What is known beforehand of how a recording lies in the world; all in the recording's frame.
struct GroundHints {
  std::optional<Eigen::Vector3d> up{};       ///< Of the recording's axes, unit.
  std::optional<Eigen::Vector3d> forward{};  ///< Of the recording's axes, unit.
  std::optional<double> camera_height{};     ///< Of the sensor above the ground [m].
  std::optional<double> camera_pitch{};      ///< Optical axis below the horizon [rad].
  /// The recording's frame is a camera's (z forward, y down), so up is about -y.
  bool optical_frame = false;
  /// Where the robot stands: ahead and left of the origin [m].
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
};

/// How a recording lies in W: z up, x forward, origin where the robot stands.
struct GroundFrame {
  Eigen::Isometry3d X_WR = Eigen::Isometry3d::Identity();  ///< Recording's frame in W.
  std::optional<PlanePatch> floor;  ///< The dominant floor, in the recording's frame.
  double floor_height = 0.0;        ///< In W, at the origin of W [m].
};

/// Without hints the dominant floor plane gives up, its height is zero, and the origin of W is the
/// floor point below the sensor. With `up` alone heights are the recording's own. An axis named as
/// `up` is turned onto the floor's normal when they differ by a few degrees, since a recording that
/// was levelled by hand is not level.
/// @return no_safe_target never; terrain_unseen with a sentence when no floor can be found.
[[nodiscard]] core::Result<GroundFrame> find_ground_frame(const std::vector<PlanePatch>& planes,
                                                          const GroundHints& hints);

}  // namespace hopscotch::perception
