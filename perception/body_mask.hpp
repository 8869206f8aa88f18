#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/depth_frame.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::perception {

/// A part of the robot's own body: all points within `radius` of a line.
struct Capsule {
  Eigen::Vector3d start;  ///< [m]
  Eigen::Vector3d end;    ///< [m]
  double radius = 0.0;    ///< [m]
};

/// Thigh, shank and foot of each leg.
inline constexpr std::size_t kBodyCapsules = 3 * core::kLegs;
using BodyCapsules = std::array<Capsule, kBodyCapsules>;

/// The legs in the camera's frame C, for the joint angles `q` [rad] and the mounting pose `X_BC`.
[[nodiscard]] BodyCapsules body_in_camera(const model::RobotParameters& robot,
                                          const core::JointVector& q,
                                          const Eigen::Isometry3d& X_BC);

}  // namespace hopscotch::perception
