#include "model/kinematics.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/unit/model/robots.hpp"

namespace hopscotch::model {
namespace {

using core::Joint;
using core::Leg;
using core::LegVector;
using Eigen::Vector3d;

constexpr double kRoundOff = 1e-12;
constexpr double kPi = std::numbers::pi;

void expect_near(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected, double tolerance) {
  EXPECT_LE((actual - expected).cwiseAbs().maxCoeff(), tolerance) << "actual\n"
                                                                  << actual << "\nexpected\n"
                                                                  << expected;
}

LegVector leg(double yaw, double roll, double hip, double knee, double ankle) {
  LegVector q;
  q << yaw, roll, hip, knee, ankle;
  return q;
}

Vector3d link_origin(const LegPoses& poses, Joint joint) {
  return poses.X_BL[core::index(joint)].translation();
}

TEST(Kinematics, StraightLegHasThePublishedJointPlaces) {
  const LegPoses poses = leg_poses(load_robot("hector"), Leg::left, LegVector::Zero());
  expect_near(link_origin(poses, Joint::hip_pitch), Vector3d(-0.0135, 0.080, -0.197), kRoundOff);
  expect_near(link_origin(poses, Joint::knee), Vector3d(-0.0135, 0.098, -0.417), kRoundOff);
  expect_near(link_origin(poses, Joint::ankle), Vector3d(-0.0135, 0.098, -0.637), kRoundOff);
  expect_near(poses.X_BF.translation(), Vector3d(-0.0035, 0.098, -0.677), kRoundOff);
}

TEST(Kinematics, NominalPostureHasThePublishedJointPlaces) {
  constexpr double kPublished = 5e-5;  // rounded to four digits
  const LegPoses poses =
      leg_poses(load_robot("hector"), Leg::left, leg(0, 0, kPi / 4, -kPi / 2, kPi / 4));
  expect_near(link_origin(poses, Joint::knee), Vector3d(-0.1691, 0.098, -0.3526), kPublished);
  expect_near(link_origin(poses, Joint::ankle), Vector3d(-0.0135, 0.098, -0.5081), kPublished);
  EXPECT_NEAR(poses.X_BF.translation().z(), -0.5481, kPublished);
  expect_near(poses.X_BF.linear(), Eigen::Matrix3d::Identity(), kRoundOff);
}

TEST(Kinematics, RightLegIsTheMirrorImage) {
  const RobotParameters robot = load_robot("hector");
  const Eigen::Matrix3d mirror = Vector3d(1.0, -1.0, 1.0).asDiagonal();
  std::mt19937 rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    const LegVector q_left = random_leg(robot, Leg::left, rng);
    LegVector q_right = q_left;
    q_right.head<2>() *= -1.0;  // yaw and roll turn the other way, pitch the same
    const Eigen::Isometry3d left = leg_poses(robot, Leg::left, q_left).X_BF;
    const Eigen::Isometry3d right = leg_poses(robot, Leg::right, q_right).X_BF;
    expect_near(right.translation(), mirror * left.translation(), kRoundOff);
    expect_near(right.linear(), mirror * left.linear() * mirror, kRoundOff);
  }
}

TEST(Kinematics, SoleJacobianIsTheDerivativeOfTheSolePose) {
  constexpr double kStep = 1e-6;
  constexpr double kTolerance = 1e-9;  // central differences: step^2 and round-off / step
  std::mt19937 rng(2);
  for (const char* name : {"hector", "hector-d14"}) {
    const RobotParameters robot = load_robot(name);
    for (int trial = 0; trial < 20; ++trial) {
      const Leg side = core::kAllLegs[static_cast<std::size_t>(trial % 2)];
      const LegVector q = random_leg(robot, side, rng);
      Eigen::Matrix<double, 6, core::kJointsPerLeg> difference;
      for (int j = 0; j < core::kJointsPerLeg; ++j) {
        LegVector ahead = q;
        LegVector behind = q;
        ahead(j) += kStep;
        behind(j) -= kStep;
        const Eigen::Isometry3d a = leg_poses(robot, side, ahead).X_BF;
        const Eigen::Isometry3d b = leg_poses(robot, side, behind).X_BF;
        const Eigen::AngleAxisd turn(a.linear() * b.linear().transpose());
        difference.col(j) << (a.translation() - b.translation()) / (2.0 * kStep),
            turn.angle() * turn.axis() / (2.0 * kStep);
      }
      expect_near(sole_jacobian(robot, side, q), difference, kTolerance);
    }
  }
}

TEST(Kinematics, SolePosesFollowTheTrunk) {
  const RobotParameters robot = load_robot("hector");
  std::mt19937 rng(3);
  const core::RobotState state = random_state(robot, rng);
  const LegVector q = state.q.tail<core::kJointsPerLeg>();
  const Eigen::Isometry3d X_BF = leg_poses(robot, Leg::right, q).X_BF;
  const Eigen::Isometry3d X_WF = sole_poses(robot, state)[core::index(Leg::right)];
  expect_near(X_WF.translation(), state.p_WB + state.R_WB * X_BF.translation(), kRoundOff);
  expect_near(X_WF.linear(), state.R_WB * X_BF.linear(), kRoundOff);
}

TEST(Kinematics, ToeAndHeelLieOnTheSoleAtTheirDistancesFromTheAnkle) {
  const RobotParameters robot = load_robot("hector");
  const LegPoses poses = leg_poses(robot, Leg::left, leg(0, 0, 0.6, -1.2, 0.6));
  const SoleTips tips = sole_tips(robot, poses.X_BF);
  const Vector3d ankle = link_origin(poses, Joint::ankle);
  expect_near(tips.toe - ankle, Vector3d(0.085, 0.0, -0.04), kRoundOff);
  expect_near(tips.heel - ankle, Vector3d(-0.065, 0.0, -0.04), kRoundOff);
}

TEST(Kinematics, InverseKinematicsReturnsTheAnglesThatMadeThePose) {
  constexpr double kAngle = 1e-9;  // acos loses half the digits towards the straight leg
  for (const char* name : {"hector", "hector-d14"}) {
    const RobotParameters robot = load_robot(name);
    for (double hip = -0.5; hip <= 2.0; hip += 0.25) {
      for (double knee = -2.6; knee <= -0.26; knee += 0.18) {
        for (double ankle = -1.3; ankle <= 1.3; ankle += 0.325) {
          const LegVector q = leg(0.0, 0.0, hip, knee, ankle);
          const Eigen::Isometry3d X_BF = leg_poses(robot, Leg::right, q).X_BF;
          const auto found = leg_inverse_kinematics(robot, X_BF.translation(), hip + knee + ankle);
          ASSERT_TRUE(found.has_value());
          expect_near(*found, q, kAngle);
        }
      }
    }
  }
}

TEST(Kinematics, InverseKinematicsPutsTheSoleWhereItWasAskedFor) {
  const RobotParameters robot = load_robot("hector");
  std::mt19937 rng(4);
  int reached = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Vector3d wanted = Vector3d(0.0, 0.0, -0.45) + random_vector<3>(0.25, rng);
    const double pitch = random_vector<1>(0.8, rng)(0);
    const auto q = leg_inverse_kinematics(robot, wanted, pitch);
    if (!q) continue;
    ++reached;
    const Eigen::Isometry3d X_BF = leg_poses(robot, Leg::left, *q).X_BF;
    EXPECT_NEAR(X_BF.translation().x(), wanted.x(), 1e-10);
    EXPECT_NEAR(X_BF.translation().z(), wanted.z(), 1e-10);
    EXPECT_NEAR(rpy_from_rotation(X_BF.linear()).y(), pitch, 1e-10);
    EXPECT_LE((*q)(static_cast<int>(Joint::knee)), 0.0);
  }
  EXPECT_GT(reached, 250);
}

TEST(Kinematics, PlacesBeyondTheStraightLegHaveNoSolution) {
  const RobotParameters robot = load_robot("hector");
  EXPECT_TRUE(leg_inverse_kinematics(robot, Vector3d(-0.0035, 0.0, -0.6769), 0.0).has_value());
  EXPECT_FALSE(leg_inverse_kinematics(robot, Vector3d(-0.0035, 0.0, -0.6771), 0.0).has_value());
  EXPECT_FALSE(leg_inverse_kinematics(robot, Vector3d(core::kNaN, 0.0, -0.5), 0.0).has_value());
}

TEST(Kinematics, RollPitchYawRoundTrips) {
  std::mt19937 rng(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Vector3d rpy = random_vector<3>(1.5, rng);
    expect_near(rpy_from_rotation(rotation_from_rpy(rpy)), rpy, kRoundOff);
  }
}

TEST(Kinematics, PositivePitchIsNoseDownAndPositiveYawTurnsLeft) {
  const Vector3d nose_pitched = rotation_from_rpy(Vector3d(0.0, 0.3, 0.0)) * Vector3d::UnitX();
  EXPECT_LT(nose_pitched.z(), 0.0);
  const Vector3d nose_yawed = rotation_from_rpy(Vector3d(0.0, 0.0, 0.3)) * Vector3d::UnitX();
  EXPECT_GT(nose_yawed.y(), 0.0);
}

TEST(Kinematics, SkewMatrixIsTheCrossProduct) {
  const Vector3d a(1.0, -2.0, 3.0);
  const Vector3d b(0.5, 4.0, -1.0);
  expect_near(skew(a) * b, a.cross(b), kRoundOff);
}

}  // namespace
}  // namespace hopscotch::model
