#include "model/motor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/model/robots.hpp"

namespace hopscotch::model {
namespace {

using core::Joint;
using core::LegVector;

constexpr double kRoundOff = 1e-12;
constexpr int kKnee = static_cast<int>(Joint::knee);
constexpr int kAnkle = static_cast<int>(Joint::ankle);

LegVector only(Joint joint, double value) {
  LegVector v = LegVector::Zero();
  v(static_cast<int>(joint)) = value;
  return v;
}

TEST(Motor, LinkageKeepsPower) {
  std::mt19937 rng(21);
  for (int trial = 0; trial < 20; ++trial) {
    const LegVector tau = random_vector<5>(60.0, rng);
    const LegVector dq = random_vector<5>(15.0, rng);
    EXPECT_NEAR(tau.dot(dq), motor_torques(tau).dot(motor_speeds(dq)), 1e-10);
  }
}

TEST(Motor, TorqueMapsAreInverse) {
  std::mt19937 rng(22);
  const LegVector tau = random_vector<5>(60.0, rng);
  EXPECT_LE((joint_torques(motor_torques(tau)) - tau).norm(), kRoundOff);
}

TEST(Motor, AnkleMotorTurnsWithKneeAndAnkle) {
  EXPECT_DOUBLE_EQ(motor_speeds(only(Joint::knee, 3.0))(kAnkle), 3.0);
  EXPECT_DOUBLE_EQ(motor_speeds(only(Joint::ankle, 2.0))(kAnkle), 2.0);
  EXPECT_DOUBLE_EQ(motor_speeds(only(Joint::ankle, 2.0))(kKnee), 0.0);
}

TEST(Motor, GivesFullTorqueUpToTheCorner) {
  const RobotParameters robot = load_robot("hector");
  for (const double speed : {0.0, 5.0, 11.72}) {
    EXPECT_NEAR(torque_bounds(robot, Joint::hip_pitch, speed).upper, 33.5, kRoundOff);
  }
  EXPECT_NEAR(torque_bounds(robot, Joint::knee, 5.86).upper, 67.0, kRoundOff);
}

TEST(Motor, TorqueFallsOnALineToZeroAtTheLargestSpeed) {
  const RobotParameters robot = load_robot("hector");
  const double half_way = 0.5 * (11.72 + 21.0);
  EXPECT_NEAR(torque_bounds(robot, Joint::ankle, half_way).upper, 33.5 / 2.0, kRoundOff);
  EXPECT_NEAR(torque_bounds(robot, Joint::ankle, 21.0).upper, 0.0, kRoundOff);
  EXPECT_DOUBLE_EQ(torque_bounds(robot, Joint::ankle, 25.0).upper, 0.0);
}

TEST(Motor, NeverMotorsWithMoreThanItsPower) {
  for (const char* name : {"hector", "hector-sim"}) {
    const RobotParameters robot = load_robot(name);
    double most = 0.0;
    for (double speed = 0.0; speed < 22.0; speed += 0.01) {
      most = std::max(most, speed * torque_bounds(robot, Joint::knee, speed).upper);
    }
    EXPECT_LE(most, 400.0 + 1e-9);
    EXPECT_GT(most, 390.0);
  }
}

TEST(Motor, BrakesWithFullTorqueUntilTheBrakingPower) {
  const RobotParameters robot = load_robot("hector");
  EXPECT_DOUBLE_EQ(torque_bounds(robot, Joint::knee, 12.0).lower, -67.0);
  EXPECT_NEAR(torque_bounds(robot, Joint::knee, 20.0).lower, -1000.0 / 20.0, kRoundOff);
}

TEST(Motor, BoundsTurnWithTheDirectionOfMotion) {
  const RobotParameters robot = load_robot("hector");
  for (const double speed : {1.0, 8.0, 14.0, 30.0}) {
    const TorqueBounds ahead = torque_bounds(robot, Joint::knee, speed);
    const TorqueBounds back = torque_bounds(robot, Joint::knee, -speed);
    EXPECT_DOUBLE_EQ(ahead.upper, -back.lower);
    EXPECT_DOUBLE_EQ(ahead.lower, -back.upper);
  }
}

TEST(Motor, StrengthScalesAllBounds) {
  const RobotParameters robot = load_robot("hector");
  for (const double speed : {0.0, 4.0, 9.0, 18.0}) {
    const TorqueBounds nominal = torque_bounds(robot, Joint::knee, speed);
    const TorqueBounds weak = torque_bounds(robot, Joint::knee, speed, 0.8);
    EXPECT_NEAR(weak.upper, 0.8 * nominal.upper, kRoundOff);
    EXPECT_NEAR(weak.lower, 0.8 * nominal.lower, kRoundOff);
  }
}

TEST(Motor, PossibleDemandsPassUnchanged) {
  const RobotParameters robot = load_robot("hector");
  LegVector tau;
  tau << 10.0, -20.0, 30.0, 60.0, 20.0;  // knee motor: 40 of 67
  EXPECT_LE((saturate(robot, tau, LegVector::Zero()) - tau).norm(), kRoundOff);
}

TEST(Motor, AnkleTorqueIsBorneByTheKneeMotorToo) {
  const RobotParameters robot = load_robot("hector");
  LegVector tau = only(Joint::knee, 67.0);
  tau(kAnkle) = -20.0;  // asks the knee motor for 87
  const LegVector real = saturate(robot, tau, LegVector::Zero());
  EXPECT_NEAR(real(kAnkle), -20.0, kRoundOff);
  EXPECT_NEAR(real(kKnee), 47.0, kRoundOff);
}

TEST(Motor, SaturatedDemandsStayWithinEveryMotor) {
  const RobotParameters robot = load_robot("hector");
  std::mt19937 rng(23);
  for (int trial = 0; trial < 200; ++trial) {
    const LegVector dq = random_vector<5>(15.0, rng);
    const LegVector real = saturate(robot, random_vector<5>(300.0, rng), dq, 0.9);
    const LegVector tau = motor_torques(real);
    const LegVector speed = motor_speeds(dq);
    for (int i = 0; i < core::kJointsPerLeg; ++i) {
      const TorqueBounds bounds = torque_bounds(robot, static_cast<Joint>(i), speed(i), 0.9);
      EXPECT_GE(tau(i), bounds.lower - 1e-9);
      EXPECT_LE(tau(i), bounds.upper + 1e-9);
    }
  }
}

TEST(Motor, LoadIsTheShareOfEachLimit) {
  const RobotParameters robot = load_robot("hector");
  const MotorLoad motoring = motor_load(robot, only(Joint::knee, 33.5), only(Joint::knee, 5.25));
  EXPECT_DOUBLE_EQ(motoring.torque_ratio(kKnee), 0.5);
  EXPECT_DOUBLE_EQ(motoring.speed_ratio(kKnee), 0.5);
  EXPECT_DOUBLE_EQ(motoring.power_ratio(kKnee), 33.5 * 5.25 / 400.0);
  EXPECT_DOUBLE_EQ(motoring.speed_ratio(kAnkle), 0.25);  // dragged along by the knee
  const MotorLoad braking = motor_load(robot, only(Joint::knee, -33.5), only(Joint::knee, 5.25));
  EXPECT_DOUBLE_EQ(braking.power_ratio(kKnee), 0.0);
}

}  // namespace
}  // namespace hopscotch::model
