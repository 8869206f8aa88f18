#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/depth_frame.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "sim/camera_settings.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/terrain.hpp"

namespace hopscotch::sim {

/// Top and sides of each slab down to the pit, and the bottom of the pit.
[[nodiscard]] std::vector<Face> terrain_faces(const Terrain& terrain);

/// Thigh (hip pitch to knee), shank (knee to ankle) and foot (heel to toe along the sole) of each
/// leg. The trunk is left out: the camera sits on its front and looks away from it.
[[nodiscard]] std::vector<Capsule> leg_capsules(const model::RobotParameters& robot,
                                                const core::RobotState& state);

/// Pinhole camera with the optical axis through the middle of the image. The field of view is that
/// of a D435 at 640x480 (focal length 385 pixels), whatever the size.
[[nodiscard]] core::CameraIntrinsics camera_intrinsics(const CameraSettings& settings);

/// X_BC: the optical axis in the trunk's xz plane, `pitch` below its x axis.
[[nodiscard]] Eigen::Isometry3d camera_mounting(const CameraSettings& settings);

}  // namespace hopscotch::sim
