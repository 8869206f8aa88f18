#include "model/leg_mirror.hpp"

#include <gtest/gtest.h>

#include "tests/unit/model/robots.hpp"

namespace hopscotch::model {
namespace {

using core::Joint;
using core::Leg;
using Eigen::Matrix3d;
using Eigen::Vector3d;

const Matrix3d kMirror = Vector3d(1.0, -1.0, 1.0).asDiagonal();

TEST(LegMirror, LeftLegIsTheFileItself) {
  const RobotParameters robot = load_robot("hector");
  const LinkParameters& thigh = robot.joints[core::index(Joint::hip_pitch)].link;
  const LinkParameters left = leg_link(robot, Leg::left, Joint::hip_pitch);
  EXPECT_EQ(left.com, thigh.com);
  EXPECT_EQ(left.inertia, thigh.inertia);
}

TEST(LegMirror, RightLinksAreReflected) {
  const RobotParameters robot = load_robot("hector-d14");
  for (const Joint joint :
       {Joint::hip_yaw, Joint::hip_roll, Joint::hip_pitch, Joint::knee, Joint::ankle}) {
    const LinkParameters left = leg_link(robot, Leg::left, joint);
    const LinkParameters right = leg_link(robot, Leg::right, joint);
    EXPECT_EQ(right.mass, left.mass);
    EXPECT_EQ(right.com, kMirror * left.com);
    EXPECT_EQ(right.inertia, kMirror * left.inertia * kMirror);
    EXPECT_EQ(joint_origin(robot, Leg::right, joint),
              kMirror * joint_origin(robot, Leg::left, joint));
  }
}

TEST(LegMirror, SoleCentreIsTheMiddleOfToeAndHeel) {
  RobotParameters robot = load_robot("hector");
  robot.sole.y() = 0.003;
  EXPECT_LE((sole_centre_in_foot(robot, Leg::left) - Vector3d(0.01, 0.003, -0.04)).norm(), 1e-15);
  EXPECT_LE((sole_centre_in_foot(robot, Leg::right) - Vector3d(0.01, -0.003, -0.04)).norm(), 1e-15);
}

}  // namespace
}  // namespace hopscotch::model
