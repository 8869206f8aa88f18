#include "sim/depth_scene.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <string>
#include <vector>

#include "model/kinematics.hpp"
#include "sim/mujoco_model.hpp"
#include "sim/robot_builder.hpp"

namespace hopscotch::sim {
namespace {

model::RobotParameters hector() {
  return model::RobotParameters::load(HOPSCOTCH_SOURCE_DIR "/config/robots/hector.yaml");
}

core::RobotState leaning_state() {
  core::RobotState state;
  state.p_WB = Eigen::Vector3d(0.4, -0.1, 0.7);
  state.R_WB = (Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()))
                   .toRotationMatrix();
  state.q << 0.1, -0.05, 0.7, -1.3, 0.4, -0.1, 0.02, 0.2, -0.9, 0.6;
  return state;
}

TEST(DepthScene, LevelMountingLooksAlongTheTrunk) {
  CameraSettings settings;
  settings.pitch = 0.0;
  const Eigen::Isometry3d X_BC = camera_mounting(settings);
  EXPECT_TRUE((X_BC * Eigen::Vector3d(1.0, 2.0, 3.0))
                  .isApprox(Eigen::Vector3d(settings.x + 3.0, -1.0, settings.z - 2.0)));
  EXPECT_NEAR(X_BC.linear().determinant(), 1.0, 1e-12);
}

TEST(DepthScene, PositivePitchLooksDown) {
  CameraSettings settings;
  settings.pitch = 0.6;
  const Eigen::Vector3d axis = camera_mounting(settings).linear() * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(axis.isApprox(Eigen::Vector3d(std::cos(0.6), 0.0, -std::sin(0.6))));
}

TEST(DepthScene, FieldOfViewDoesNotDependOnTheImageSize) {
  CameraSettings settings;
  const core::CameraIntrinsics large = camera_intrinsics(settings);
  settings.width = 320;
  settings.height = 240;
  const core::CameraIntrinsics small = camera_intrinsics(settings);
  EXPECT_DOUBLE_EQ(large.fx, 385.0);
  EXPECT_DOUBLE_EQ(large.fx / large.width, small.fx / small.width);
  EXPECT_DOUBLE_EQ(small.cx, 159.5);
  EXPECT_DOUBLE_EQ(small.cy, 119.5);
}

/// Looking straight down, every pixel must give the height that the terrain itself reports.
TEST(DepthScene, DepthFromAboveIsTheTerrainsOwnHeight) {
  Terrain terrain;
  terrain.pit_depth = 0.4;
  terrain.slabs.push_back(
      {.centre = {0.0, 0.0}, .half_size = {0.5, 0.3}, .top = 0.1, .slope = 0.2, .yaw = 0.4});
  terrain.slabs.push_back({.centre = {0.9, 0.1}, .half_size = {0.2, 0.3}, .top = -0.1});
  const core::CameraIntrinsics camera{200, 150, 120.0, 120.0, 99.5, 74.5};
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  X_WC.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  X_WC.translation() = Eigen::Vector3d(0.3, 0.0, 1.5);
  DepthRenderer renderer(camera, DepthRange{});
  std::vector<float> depth;
  renderer.render(terrain_faces(terrain), {}, X_WC, depth);

  int tops = 0;
  int wrong = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double z = static_cast<double>(depth[static_cast<std::size_t>(v * camera.width + u)]);
      const Eigen::Vector3d p_W =
          X_WC * (z * Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1));
      const double floor = -terrain.pit_depth;
      const double height = terrain.top_at(p_W.head<2>()).value_or(floor);
      if (height > floor) ++tops;
      const bool on_wall = p_W.z() > floor + 1e-3 && p_W.z() < height - 1e-3;
      if (!on_wall && std::abs(p_W.z() - height) > 1e-3) ++wrong;
    }
  }
  EXPECT_GT(tops, 5000);
  // Points of a wall lie on the outline, where rounding decides between slab and pit.
  constexpr int kWallPixels = 600;
  EXPECT_LT(wrong, kWallPixels);
}

/// The renderer and the physics must speak of the same legs.
TEST(DepthScene, ThighsAndShanksAreTheCollisionGeomsOfThePlant) {
  const model::RobotParameters robot = hector();
  const core::RobotState state = leaning_state();
  const ModelPointer world = compile_model(standalone_robot_mjcf(robot));
  const DataPointer data = make_data(*world);
  const Eigen::Quaterniond rotation(state.R_WB);
  Eigen::Map<Eigen::Vector3d>(data->qpos) = state.p_WB;
  Eigen::Map<Eigen::Vector4d>(data->qpos + 3) =
      Eigen::Vector4d(rotation.w(), rotation.x(), rotation.y(), rotation.z());
  Eigen::Map<core::JointVector>(data->qpos + 7) = state.q;
  mj_kinematics(world.get(), data.get());

  const std::vector<Capsule> capsules = leg_capsules(robot, state);
  ASSERT_EQ(capsules.size(), 6U);
  std::size_t next = 0;
  for (const std::string side : {"left_", "right_"}) {
    for (const std::string part : {"thigh", "shank"}) {
      const int geom = element_id(*world, mjOBJ_GEOM, side + part);
      const Eigen::Vector3d centre = Eigen::Map<const Eigen::Vector3d>(data->geom_xpos + 3 * geom);
      const Capsule& capsule = capsules[next++];
      EXPECT_NEAR((0.5 * (capsule.a + capsule.b) - centre).norm(), 0.0, 1e-9) << side << part;
      EXPECT_NEAR(0.5 * (capsule.b - capsule.a).norm(), world->geom_size[3 * geom + 1], 1e-9);
      EXPECT_NEAR(capsule.radius, world->geom_size[3 * geom], 1e-12);
    }
    ++next;  // the foot, below
  }
}

TEST(DepthScene, FeetReachFromHeelToToeOnTheSole) {
  const model::RobotParameters robot = hector();
  const core::RobotState state = leaning_state();
  const auto soles = model::sole_poses(robot, state);
  const std::vector<Capsule> capsules = leg_capsules(robot, state);
  for (std::size_t leg = 0; leg < 2; ++leg) {
    const Capsule& foot = capsules[3 * leg + 2];
    const model::SoleTips tips = model::sole_tips(robot, soles[leg]);
    const Eigen::Vector3d along = (foot.b - foot.a).normalized();
    const Eigen::Vector3d up = soles[leg].linear().col(2);
    EXPECT_NEAR((foot.b + foot.radius * along - foot.radius * up - tips.toe).norm(), 0.0, 1e-9);
    EXPECT_NEAR((foot.a - foot.radius * along - foot.radius * up - tips.heel).norm(), 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace hopscotch::sim
