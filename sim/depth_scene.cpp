#include "sim/depth_scene.hpp"

#include <array>
#include <cstddef>

#include "model/kinematics.hpp"

namespace hopscotch::sim {
namespace {

/// Half length of the bottom of the pit: beyond the sensor's range from any place of a run [m].
constexpr double kPitReach = 100.0;

constexpr double kD435Focal = 385.0;  // [pixel] at kD435Width
constexpr double kD435Width = 640.0;  // [pixel]

Eigen::Vector3d at_height(const Eigen::Vector3d& p, double z) {
  return {p.x(), p.y(), z};
}

void append_slab_faces(const Slab& slab, double bottom, std::vector<Face>& faces) {
  const std::array<Eigen::Vector3d, 4> top = slab.top_corners();
  faces.push_back({top});
  for (std::size_t i = 0; i < top.size(); ++i) {
    const Eigen::Vector3d& next = top[(i + 1) % top.size()];
    faces.push_back({{top[i], next, at_height(next, bottom), at_height(top[i], bottom)}});
  }
}

}  // namespace

std::vector<Face> terrain_faces(const Terrain& terrain) {
  const double bottom = -terrain.pit_depth;
  std::vector<Face> faces;
  faces.push_back({{Eigen::Vector3d(-kPitReach, -kPitReach, bottom),
                    Eigen::Vector3d(kPitReach, -kPitReach, bottom),
                    Eigen::Vector3d(kPitReach, kPitReach, bottom),
                    Eigen::Vector3d(-kPitReach, kPitReach, bottom)}});
  for (const Slab& slab : terrain.slabs) append_slab_faces(slab, bottom, faces);
  return faces;
}

std::vector<Capsule> leg_capsules(const model::RobotParameters& robot,
                                  const core::RobotState& state) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = state.R_WB;
  X_WB.translation() = state.p_WB;
  std::vector<Capsule> capsules;
  for (const core::Leg leg : core::kAllLegs) {
    const core::LegVector q = state.q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
    const model::LegPoses poses = model::leg_poses(robot, leg, q);
    const auto joint = [&](core::Joint j) -> Eigen::Vector3d {
      return X_WB * poses.X_BL[core::index(j)].translation();
    };
    const Eigen::Vector3d hip = joint(core::Joint::hip_pitch);
    const Eigen::Vector3d knee = joint(core::Joint::knee);
    // The thigh's round ends lie inside the leg, so that the knee is as thin as the shank.
    const Eigen::Vector3d end = robot.thigh_radius * (knee - hip).normalized();
    capsules.push_back({hip + end, knee - end, robot.thigh_radius});
    capsules.push_back({knee, joint(core::Joint::ankle), robot.shank_radius});

    const Eigen::Isometry3d X_WF = X_WB * poses.X_BF;
    const double radius = 0.5 * robot.foot_width;
    const Eigen::Vector3d up = radius * Eigen::Vector3d::UnitZ();  // the sole touches the capsule
    const double half_length = 0.5 * (robot.toe + robot.heel);
    const Eigen::Vector3d forward = (half_length - radius) * Eigen::Vector3d::UnitX();
    capsules.push_back({X_WF * (up - forward), X_WF * (up + forward), radius});
  }
  return capsules;
}

core::CameraIntrinsics camera_intrinsics(const CameraSettings& settings) {
  const double focal = kD435Focal * settings.width / kD435Width;
  return {.width = settings.width,
          .height = settings.height,
          .fx = focal,
          .fy = focal,
          .cx = 0.5 * (settings.width - 1),
          .cy = 0.5 * (settings.height - 1)};
}

Eigen::Isometry3d camera_mounting(const CameraSettings& settings) {
  Eigen::Matrix3d R_BC_level;   // columns: right, down, forward
  R_BC_level << 0.0, 0.0, 1.0,  //
      -1.0, 0.0, 0.0,           //
      0.0, -1.0, 0.0;
  Eigen::Isometry3d X_BC = Eigen::Isometry3d::Identity();
  X_BC.linear() = Eigen::AngleAxisd(settings.pitch, Eigen::Vector3d::UnitY()) * R_BC_level;
  X_BC.translation() = Eigen::Vector3d(settings.x, 0.0, settings.z);
  return X_BC;
}

}  // namespace hopscotch::sim
