#include "core/robot_layout.hpp"

#include <gtest/gtest.h>

#include <set>

namespace hopscotch::core {
namespace {

TEST(RobotLayout, LeftLegComesFirstTrunkToFoot) {
  EXPECT_EQ(joint_index(Leg::left, Joint::hip_yaw), 0);
  EXPECT_EQ(joint_index(Leg::left, Joint::ankle), 4);
  EXPECT_EQ(joint_index(Leg::right, Joint::hip_yaw), 5);
  EXPECT_EQ(joint_index(Leg::right, Joint::ankle), 9);
}

TEST(RobotLayout, JointIndicesFillTheVectorOnce) {
  std::set<int> indices;
  for (const Leg leg : kAllLegs) {
    for (int joint = 0; joint < kJointsPerLeg; ++joint) {
      indices.insert(joint_index(leg, static_cast<Joint>(joint)));
    }
  }
  EXPECT_EQ(indices.size(), static_cast<std::size_t>(kJoints));
  EXPECT_EQ(*indices.begin(), 0);
  EXPECT_EQ(*indices.rbegin(), kJoints - 1);
}

TEST(RobotLayout, LegOffsetIsItsFirstJoint) {
  for (const Leg leg : kAllLegs) EXPECT_EQ(leg_offset(leg), joint_index(leg, Joint::hip_yaw));
}

TEST(RobotLayout, NamesFollowTheIndexOrder) {
  EXPECT_EQ(kJointNames[index(Joint::hip_roll)], "hip_roll");
  EXPECT_EQ(kJointNames[index(Joint::knee)], "knee");
  EXPECT_EQ(kLegNames[index(Leg::right)], "right");
}

}  // namespace
}  // namespace hopscotch::core
