#include "model/robot_parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "core/config_reader.hpp"
#include "tests/unit/model/robots.hpp"

namespace hopscotch::model {
namespace {

using core::Joint;
using core::Leg;

TEST(RobotParameters, SetsRAndD14HaveThePublishedMass) {
  EXPECT_NEAR(load_robot("hector").total_mass(), 14.046, 1e-9);
  EXPECT_NEAR(load_robot("hector-d14").total_mass(), 14.0, 1e-9);
}

TEST(RobotParameters, EveryRobotHasTwentyTwoCentimetreLegLinks) {
  for (const char* name : {"hector", "hector-d14", "hector-urdf", "hector-sim"}) {
    const RobotParameters robot = load_robot(name);
    EXPECT_EQ(robot.name, name);
    EXPECT_DOUBLE_EQ(robot.thigh_length(), 0.22);
    EXPECT_DOUBLE_EQ(robot.shank_length(), 0.22);
    EXPECT_DOUBLE_EQ(robot.sole_centre(), 0.01);
  }
}

TEST(RobotParameters, VariantsDifferFromHectorInTheKneeMotorOnly) {
  const RobotParameters hector = load_robot("hector");
  const std::size_t knee = core::index(Joint::knee);
  for (const auto& [name, speed] :
       {std::pair("hector-urdf", 14.0), std::pair("hector-sim", 21.0)}) {
    const RobotParameters variant = load_robot(name);
    EXPECT_DOUBLE_EQ(variant.motors[knee].speed_max, speed);
    EXPECT_DOUBLE_EQ(variant.motors[knee].torque_max, hector.motors[knee].torque_max);
    EXPECT_NEAR(variant.motors[knee].corner_speed / speed,
                hector.motors[knee].corner_speed / hector.motors[knee].speed_max, 1e-4);
    EXPECT_DOUBLE_EQ(variant.motors[0].speed_max, hector.motors[0].speed_max);
    EXPECT_DOUBLE_EQ(variant.total_mass(), hector.total_mass());
  }
}

TEST(RobotParameters, KneeMotorIsTheCommonMotorBehindTwoToOne) {
  const RobotParameters robot = load_robot("hector");
  const MotorParameters& hip = robot.motors[core::index(Joint::hip_pitch)];
  const MotorParameters& knee = robot.motors[core::index(Joint::knee)];
  EXPECT_DOUBLE_EQ(knee.torque_max, 2.0 * hip.torque_max);
  EXPECT_DOUBLE_EQ(knee.speed_max, hip.speed_max / 2.0);
  EXPECT_DOUBLE_EQ(knee.corner_speed, hip.corner_speed / 2.0);
  EXPECT_DOUBLE_EQ(knee.armature, 4.0 * hip.armature);
}

TEST(RobotParameters, YawAndRollRangesMirrorOnTheRight) {
  RobotParameters robot = load_robot("hector");
  robot.joints[core::index(Joint::hip_roll)].lower = -0.3;
  robot.joints[core::index(Joint::hip_roll)].upper = 0.5;
  const JointRange right_roll = joint_range(robot, Leg::right, Joint::hip_roll);
  EXPECT_DOUBLE_EQ(right_roll.lower, -0.5);
  EXPECT_DOUBLE_EQ(right_roll.upper, 0.3);
  const JointRange right_knee = joint_range(robot, Leg::right, Joint::knee);
  EXPECT_DOUBLE_EQ(right_knee.lower, robot.joints[core::index(Joint::knee)].lower);
  EXPECT_DOUBLE_EQ(right_knee.upper, robot.joints[core::index(Joint::knee)].upper);
}

/// The text of hector.yaml with its first `original` replaced.
std::string broken_file(const std::string& original, const std::string& replacement) {
  std::ifstream in(robot_file("hector"));
  std::stringstream text;
  text << in.rdbuf();
  std::string content = text.str();
  const std::size_t place = content.find(original);
  EXPECT_NE(place, std::string::npos) << original;
  content.replace(place, original.size(), replacement);
  const std::string path = testing::TempDir() + "broken_robot_" +
                           testing::UnitTest::GetInstance()->current_test_info()->name() + ".yaml";
  std::ofstream(path) << content;
  return path;
}

std::string message_of(const std::string& path) {
  try {
    static_cast<void>(RobotParameters::load(path));
  } catch (const core::ConfigError& error) {
    return error.what();
  }
  return "loaded without complaint";
}

TEST(RobotParameters, BrokenFilesAreRefusedWithKeyAndRule) {
  struct Case {
    const char* original;
    const char* replacement;
    const char* message;
  };
  for (const Case& c : {
           Case{"mass_kg: 0.874", "mass_kg: -0.874", "joints.hip_yaw.link.mass_kg = -0.874"},
           Case{"mass_kg: 0.874", "mass_g: 874.0", "joints.hip_yaw.link.mass_kg is missing"},
           Case{"toe_m: 0.085", "toe_m: 0.085\n  toe_radius_m: 0.01",
                "foot.toe_radius_m is not a known key"},
           Case{"[0.0479073, 0.03785748, 0.02538835", "[0.0479073, 0.01, 0.02538835",
                "trunk.inertia_kgm2"},
           Case{"[0.0, 0.018, -0.22]", "[0.01, 0.018, -0.22]", "straight below the joint above"},
           Case{"axis: [0, 0, 1]", "axis: [0, 1, 0]", "joints.hip_yaw.axis"},
           Case{"range_rad: [-2.6180, -0.2618]", "range_rad: [-0.2618, -2.6180]",
                "joints.knee.range_rad"},
           Case{"corner_speed_radps: 5.86", "corner_speed_radps: 10.6", "must be below speed_max"},
           Case{"motor_power_max_W: 400.0", "motor_power_max_W: lots", "must be a number"},
           Case{"name: hector", "name: hector\nbased_on: nobody", "nobody.yaml: no such file"},
       }) {
    EXPECT_THAT(message_of(broken_file(c.original, c.replacement)), testing::HasSubstr(c.message));
  }
}

TEST(RobotParameters, MissingFileIsNamed) {
  EXPECT_THAT(message_of("no-such-robot.yaml"), testing::HasSubstr("no-such-robot.yaml"));
}

}  // namespace
}  // namespace hopscotch::model
