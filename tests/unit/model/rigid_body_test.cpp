#include "model/rigid_body.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/unit/model/robots.hpp"

namespace hopscotch::model {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kRoundOff = 1e-12;

struct PublishedPosture {
  const char* robot;
  double hip_deg;
  double com_height;  // above the sole [m]
  double com_x;       // ahead of the ankle [m]
  Vector3d inertia;   // about G [kg m^2]
};

TEST(RigidBody, StandingPosturesMatchThePublishedTable) {
  constexpr double kPublished = 1.1e-5;  // five digits, from links rounded alike
  for (const PublishedPosture& row : {
           PublishedPosture{"hector", 0.0, 0.51952, 0.01612, {0.53242, 0.45094, 0.12325}},
           PublishedPosture{"hector", 45.0, 0.40355, 0.00144, {0.42289, 0.36416, 0.14600}},
           PublishedPosture{"hector", 60.0, 0.32154, -0.00186, {0.36147, 0.31228, 0.15553}},
           PublishedPosture{"hector-d14", 0.0, 0.55348, 0.02088, {0.42694, 0.37433, 0.11490}},
           PublishedPosture{"hector-d14", 45.0, 0.43258, 0.00851, {0.36294, 0.32944, 0.13401}},
           PublishedPosture{"hector-d14", 60.0, 0.34701, 0.00565, {0.32713, 0.30191, 0.14229}},
       }) {
    const RobotParameters robot = load_robot(row.robot);
    const double hip = row.hip_deg * kPi / 180.0;
    const core::RobotState state = standing_state(robot, hip, -2.0 * hip);
    const core::LegVector q = state.q.head<core::kJointsPerLeg>();
    const Vector3d p_BA =
        leg_poses(robot, core::Leg::left, q).X_BL[core::index(core::Joint::ankle)].translation();
    const CompositeBody body = composite_body(robot, state);
    EXPECT_NEAR(body.p_WG.z(), row.com_height, kPublished);
    EXPECT_NEAR(body.p_WG.x() - p_BA.x(), row.com_x, kPublished);
    EXPECT_NEAR(body.p_WG.y(), 0.0, kRoundOff);
    EXPECT_LE((body.inertia_W.diagonal() - row.inertia).cwiseAbs().maxCoeff(), kPublished)
        << row.robot << " at " << row.hip_deg << " deg:\n"
        << body.inertia_W;
  }
}

/// The state a short time later, at constant rates.
core::RobotState drift(const core::RobotState& state, double time) {
  core::RobotState later = state;
  const double angle = state.w_WB.norm() * time;
  later.p_WB += state.v_WB * time;
  later.R_WB = Eigen::AngleAxisd(angle, state.w_WB.normalized()) * state.R_WB;
  later.q += state.dq * time;
  return later;
}

TEST(RigidBody, VelocityIsTheDerivativeOfTheCentreOfMass) {
  constexpr double kStep = 1e-6;
  constexpr double kTolerance =
      1e-8;  // second derivative of the CoM ~ 1e2, times step^2; round-off
  std::mt19937 rng(11);
  for (int trial = 0; trial < 10; ++trial) {
    const RobotParameters robot = load_robot(trial % 2 == 0 ? "hector" : "hector-d14");
    const core::RobotState state = random_state(robot, rng);
    const Vector3d ahead = composite_body(robot, drift(state, kStep)).p_WG;
    const Vector3d behind = composite_body(robot, drift(state, -kStep)).p_WG;
    const Vector3d difference = (ahead - behind) / (2.0 * kStep);
    EXPECT_LE((composite_body(robot, state).v_WG - difference).norm(), kTolerance);
  }
}

TEST(RigidBody, LockedJointsHaveTheMomentumOfOneBody) {
  std::mt19937 rng(12);
  const RobotParameters robot = load_robot("hector");
  core::RobotState state = random_state(robot, rng);
  state.dq.setZero();
  const CompositeBody body = composite_body(robot, state);
  EXPECT_LE((body.momentum_W - body.inertia_W * state.w_WB).norm(), kRoundOff);
  const Vector3d v_rigid = state.v_WB + state.w_WB.cross(body.p_WG - state.p_WB);
  EXPECT_LE((body.v_WG - v_rigid).norm(), kRoundOff);
}

TEST(RigidBody, AngularMomentumIgnoresTheMotionOfTheObserver) {
  std::mt19937 rng(13);
  const RobotParameters robot = load_robot("hector");
  core::RobotState state = random_state(robot, rng);
  const CompositeBody still = composite_body(robot, state);
  const Vector3d shift(0.3, -0.2, 0.7);
  state.v_WB += shift;
  state.p_WB -= shift;
  const CompositeBody moved = composite_body(robot, state);
  EXPECT_LE((moved.momentum_W - still.momentum_W).norm(), kRoundOff);
  EXPECT_LE((moved.inertia_W - still.inertia_W).norm(), kRoundOff);
  EXPECT_LE((moved.v_WG - still.v_WG - shift).norm(), kRoundOff);
}

TEST(RigidBody, MirroredPosturesHaveMirroredMassProperties) {
  const Matrix3d mirror = Vector3d(1.0, -1.0, 1.0).asDiagonal();
  std::mt19937 rng(14);
  const RobotParameters robot = load_robot("hector");
  core::RobotState state = random_state(robot, rng);
  state.R_WB.setIdentity();
  state.p_WB.setZero();
  core::RobotState mirrored = state;
  mirrored.q << state.q.tail<5>(), state.q.head<5>();
  for (const core::Leg leg : core::kAllLegs) {
    mirrored.q.segment<2>(core::leg_offset(leg)) *= -1.0;
  }
  const CompositeBody body = composite_body(robot, state);
  const CompositeBody image = composite_body(robot, mirrored);
  EXPECT_LE((image.p_WG - mirror * body.p_WG).norm(), kRoundOff);
  EXPECT_LE((image.inertia_W - mirror * body.inertia_W * mirror).norm(), kRoundOff);
}

}  // namespace
}  // namespace hopscotch::model
