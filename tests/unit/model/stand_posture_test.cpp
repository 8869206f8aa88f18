#include "model/stand_posture.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"

namespace hopscotch::model {
namespace {

constexpr double kRounding = 1e-9;

RobotParameters hector() {
  return RobotParameters::load(std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config" / "robots" /
                               "hector.yaml");
}

const StandPosture kPosture{.com_height = 0.39, .com_x = 0.005, .trunk_pitch = 0.2};

/// The pose as a robot state with the mid-point of the soles at the origin of W.
core::RobotState state_of(const StandPose& pose) {
  core::RobotState state;
  state.p_WB = {pose.trunk_x, 0.0, pose.trunk_height};
  state.R_WB = rotation_from_rpy({0.0, pose.trunk_pitch, 0.0});
  state.v_WB.setZero();
  state.w_WB.setZero();
  state.q = pose.q;
  state.dq.setZero();
  return state;
}

TEST(StandPosture, PutsTheWholeBodyCentreOfMassWhereItIsAskedFor) {
  const RobotParameters robot = hector();
  const std::optional<StandPose> pose = stand_pose(robot, kPosture);
  ASSERT_TRUE(pose);
  const CompositeBody body = composite_body(robot, state_of(*pose));
  EXPECT_NEAR(body.p_WG.x(), kPosture.com_x, kRounding);
  EXPECT_NEAR(body.p_WG.y(), 0.0, kRounding);
  EXPECT_NEAR(body.p_WG.z(), kPosture.com_height, kRounding);
}

TEST(StandPosture, StandsOnFlatSolesAtTheOrigin) {
  const RobotParameters robot = hector();
  const std::optional<StandPose> pose = stand_pose(robot, kPosture);
  ASSERT_TRUE(pose);
  for (const Eigen::Isometry3d& X_WF : sole_poses(robot, state_of(*pose))) {
    EXPECT_NEAR(X_WF.translation().x(), 0.0, kRounding);
    EXPECT_NEAR(X_WF.translation().z(), 0.0, kRounding);
    EXPECT_TRUE(X_WF.linear().isIdentity(kRounding));
  }
}

TEST(StandPosture, BendsTheKneesBackward) {
  const std::optional<StandPose> pose = stand_pose(hector(), kPosture);
  ASSERT_TRUE(pose);
  EXPECT_LT(pose->q(core::joint_index(core::Leg::left, core::Joint::knee)), 0.0);
  EXPECT_LT(pose->pitch[kShank], 0.0);
}

TEST(StandPosture, OutOfReachIsNoPosture) {
  EXPECT_FALSE(stand_pose(hector(), {.com_height = 0.60, .com_x = 0.0, .trunk_pitch = 0.0}));
  EXPECT_FALSE(stand_pose(hector(), {.com_height = 0.20, .com_x = 0.0, .trunk_pitch = 0.0}));
}

TEST(StandPosture, LinksFromComInvertsTheCentreOfMass) {
  const PlanarDynamics dynamics(lump_legs(hector()));
  const LinkArray<double> posture{0.1, -0.8, 0.9, 0.3};
  const std::optional<LinkArray<double>> found =
      links_from_com(dynamics, dynamics.com(posture), {0.1, 0.0, 0.0, 0.3});
  ASSERT_TRUE(found);
  for (std::size_t j = 0; j < kPlanarLinks; ++j) EXPECT_NEAR((*found)[j], posture[j], kRounding);
}

TEST(StandPosture, ConfigurationRejectsAKneelingRobot) {
  const core::ConfigReader reader = core::ConfigReader::from_text(
      "com_height_m: 0.1\ncom_ahead_of_sole_centre_m: 0.0\ntrunk_pitch_rad: 0.2\n", "test.yaml");
  EXPECT_THROW(StandPosture::load(reader), core::ConfigError);
}

}  // namespace
}  // namespace hopscotch::model
