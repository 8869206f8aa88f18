#include "sim/robot_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>

#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"
#include "tests/unit/sim/mujoco_robot.hpp"

namespace hopscotch::sim {
namespace {

using core::Joint;
using core::Leg;
using Eigen::Vector3d;

constexpr double kAgreement = 1e-8;  // asked of model and MuJoCo; round-off is far below
constexpr int kTrials = 25;

std::string name_of(Leg leg, const std::string& part) {
  return std::string(core::kLegNames[core::index(leg)]) + "_" + part;
}

/// Every robot file, with a seeded stream of random states.
class RobotBuilder : public testing::TestWithParam<const char*> {
 protected:
  MujocoRobot mujoco{GetParam()};
  std::mt19937 rng{31};

  core::RobotState place_at_random() {
    const core::RobotState state = model::random_state(mujoco.robot, rng);
    mujoco.place(state);
    return state;
  }
};

INSTANTIATE_TEST_SUITE_P(Robots, RobotBuilder,
                         testing::Values("hector", "hector-d14", "hector-urdf", "hector-sim"),
                         [](const auto& robot) {
                           std::string name = robot.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(RobotBuilder, JointsAndMotorsStandInTheOrderOfTheJointVector) {
  ASSERT_EQ(mujoco.mj->nq, 7 + core::kJoints);
  ASSERT_EQ(mujoco.mj->nv, 6 + core::kJoints);
  ASSERT_EQ(mujoco.mj->nu, core::kJoints);
  for (const Leg leg : core::kAllLegs) {
    for (std::size_t j = 0; j < core::kJointNames.size(); ++j) {
      const std::string name = name_of(leg, std::string(core::kJointNames[j]));
      const int i = core::joint_index(leg, static_cast<Joint>(j));
      const int id = element_id(*mujoco.mj, mjOBJ_JOINT, name);
      EXPECT_EQ(mujoco.mj->jnt_qposadr[id], 7 + i);
      EXPECT_EQ(element_id(*mujoco.mj, mjOBJ_ACTUATOR, name), i);
      EXPECT_EQ(mujoco.mj->actuator_trnid[2 * i], id);
    }
  }
}

TEST_P(RobotBuilder, LinkAndSolePosesAgreeWithMuJoCo) {
  const std::array<const char*, core::kJointsPerLeg> links{"hip", "hip2", "thigh", "shank", "foot"};
  for (int trial = 0; trial < kTrials; ++trial) {
    const core::RobotState state = place_at_random();
    const std::array<Eigen::Isometry3d, core::kLegs> X_WF = model::sole_poses(mujoco.robot, state);
    for (const Leg leg : core::kAllLegs) {
      const Eigen::Isometry3d sole = mujoco.site_pose(name_of(leg, "sole"));
      EXPECT_LE((X_WF[core::index(leg)].matrix() - sole.matrix()).norm(), kAgreement);
      const core::LegVector q = state.q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
      const model::LegPoses poses = model::leg_poses(mujoco.robot, leg, q);
      for (std::size_t i = 0; i < links.size(); ++i) {
        const Eigen::Isometry3d link = mujoco.body_pose(name_of(leg, links[i]));
        const Vector3d p_WL = state.p_WB + state.R_WB * poses.X_BL[i].translation();
        EXPECT_LE((p_WL - link.translation()).norm(), kAgreement);
        EXPECT_LE((state.R_WB * poses.X_BL[i].linear() - link.linear()).norm(), kAgreement);
      }
    }
  }
}

TEST_P(RobotBuilder, SoleJacobiansAgreeWithMuJoCo) {
  using Rows = Eigen::Matrix<double, 3, MujocoRobot::kVelocities, Eigen::RowMajor>;
  for (int trial = 0; trial < kTrials; ++trial) {
    const core::RobotState state = place_at_random();
    for (const Leg leg : core::kAllLegs) {
      Rows linear;
      Rows angular;
      mj_jacSite(mujoco.mj.get(), mujoco.data.get(), linear.data(), angular.data(),
                 element_id(*mujoco.mj, mjOBJ_SITE, name_of(leg, "sole")));
      const int offset = core::leg_offset(leg);
      const core::LegVector q = state.q.segment<core::kJointsPerLeg>(offset);
      const Eigen::Matrix<double, 6, 5> J = model::sole_jacobian(mujoco.robot, leg, q);
      EXPECT_LE((state.R_WB * J.topRows<3>() - linear.middleCols<5>(6 + offset)).norm(),
                kAgreement);
      EXPECT_LE((state.R_WB * J.bottomRows<3>() - angular.middleCols<5>(6 + offset)).norm(),
                kAgreement);
    }
  }
}

TEST_P(RobotBuilder, CentreOfMassAndItsVelocityAgreeWithMuJoCo) {
  const int trunk = element_id(*mujoco.mj, mjOBJ_BODY, "trunk");
  for (int trial = 0; trial < kTrials; ++trial) {
    const model::CompositeBody body = model::composite_body(mujoco.robot, place_at_random());
    mj_subtreeVel(mujoco.mj.get(), mujoco.data.get());
    const Eigen::Map<const Vector3d> com(mujoco.data->subtree_com + 3 * trunk);
    const Eigen::Map<const Vector3d> velocity(mujoco.data->subtree_linvel + 3 * trunk);
    EXPECT_NEAR(body.mass, mujoco.mj->body_subtreemass[trunk], kAgreement);
    EXPECT_LE((body.p_WG - com).norm(), kAgreement);
    EXPECT_LE((body.v_WG - velocity).norm(), kAgreement);
  }
}

TEST_P(RobotBuilder, AngularMomentumAgreesWithMuJoCo) {
  const int trunk = element_id(*mujoco.mj, mjOBJ_BODY, "trunk");
  for (int trial = 0; trial < kTrials; ++trial) {
    const model::CompositeBody body = model::composite_body(mujoco.robot, place_at_random());
    mj_subtreeVel(mujoco.mj.get(), mujoco.data.get());
    const Eigen::Map<const Vector3d> momentum(mujoco.data->subtree_angmom + 3 * trunk);
    EXPECT_LE((body.momentum_W - momentum).norm(), kAgreement);
  }
}

TEST_P(RobotBuilder, CompositeInertiaAgreesWithMuJoCo) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const core::RobotState state = place_at_random();
    const model::CompositeBody body = model::composite_body(mujoco.robot, state);
    // The mass matrix of the free joint is the inertia about B, in B.
    const Eigen::Matrix3d about_B =
        state.R_WB * mujoco.mass_matrix().block<3, 3>(3, 3) * state.R_WB.transpose();
    const Eigen::Matrix3d lever = model::skew(body.p_WG - state.p_WB);
    const Eigen::Matrix3d about_G = about_B + body.mass * lever * lever;
    EXPECT_LE((body.inertia_W - about_G).norm(), kAgreement);
  }
}

TEST_P(RobotBuilder, JointRangesAreThoseOfTheModel) {
  for (const Leg leg : core::kAllLegs) {
    for (std::size_t i = 0; i < core::kJointNames.size(); ++i) {
      const int id =
          element_id(*mujoco.mj, mjOBJ_JOINT, name_of(leg, std::string(core::kJointNames[i])));
      const model::JointRange range = model::joint_range(mujoco.robot, leg, static_cast<Joint>(i));
      EXPECT_TRUE(mujoco.mj->jnt_limited[id] != 0);
      EXPECT_DOUBLE_EQ(mujoco.mj->jnt_range[2 * id], range.lower);
      EXPECT_DOUBLE_EQ(mujoco.mj->jnt_range[2 * id + 1], range.upper);
    }
  }
}

TEST_P(RobotBuilder, FootSpheresTouchTheSolePlaneBelowToeAndHeel) {
  core::RobotState level;
  level.p_WB.setZero();
  level.R_WB.setIdentity();
  level.v_WB.setZero();
  level.w_WB.setZero();
  level.q.setZero();
  level.dq.setZero();
  mujoco.place(level);
  const auto X_WF = model::sole_poses(mujoco.robot, level);
  for (const Leg leg : core::kAllLegs) {
    const model::SoleTips tips = model::sole_tips(mujoco.robot, X_WF[core::index(leg)]);
    for (const auto& [part, tip] : {std::pair("toe", tips.toe), std::pair("heel", tips.heel)}) {
      const int id = element_id(*mujoco.mj, mjOBJ_GEOM, name_of(leg, part));
      const double radius = mujoco.mj->geom_size[3 * id];
      const Eigen::Map<const Vector3d> centre(mujoco.data->geom_xpos + 3 * id);
      EXPECT_LE((centre - radius * Vector3d::UnitZ() - tip).norm(), kAgreement);
    }
  }
}

TEST_P(RobotBuilder, RestingImuFeelsGravityAlongTrunkZ) {
  core::RobotState state = model::random_state(mujoco.robot, rng);
  state.v_WB.setZero();
  state.w_WB.setZero();
  state.dq.setZero();
  mujoco.place(state);
  const mjModel& mj = *mujoco.mj;
  const int gyro = mj.sensor_adr[element_id(mj, mjOBJ_SENSOR, "gyro")];
  EXPECT_LE(Eigen::Map<const Vector3d>(mujoco.data->sensordata + gyro).norm(), kAgreement);
  // Falling: the accelerometer feels the trunk's acceleration less gravity.
  const int accelerometer = mj.sensor_adr[element_id(mj, mjOBJ_SENSOR, "accelerometer")];
  const Eigen::Map<const Vector3d> felt(mujoco.data->sensordata + accelerometer);
  const Vector3d expected =
      state.R_WB.transpose() * (mujoco.acceleration().head<3>() - Vector3d(mj.opt.gravity));
  EXPECT_LE((felt - expected).norm(), kAgreement);
}

TEST_P(RobotBuilder, RobotTouchesTerrainAndNeverItself) {
  const mjModel& mj = *mujoco.mj;
  int touchable = 0;
  for (int i = 0; i < mj.ngeom; ++i) {
    const int type = mj.geom_contype[i];
    const int affinity = mj.geom_conaffinity[i];
    if (type == 0 && affinity == 0) continue;
    ++touchable;
    EXPECT_EQ(type & affinity, 0);
    EXPECT_NE((type & kTerrainConaffinity) | (affinity & kTerrainContype), 0);
    EXPECT_EQ(mj.geom_group[i], kCollisionGroup);
  }
  EXPECT_EQ(touchable, 1 + core::kLegs * 5);  // trunk; thigh, shank, toe, heel, bar
}

}  // namespace
}  // namespace hopscotch::sim
