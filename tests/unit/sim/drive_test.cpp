#include "sim/drive.hpp"

#include <gtest/gtest.h>

#include "model/motor.hpp"
#include "sim/random.hpp"

namespace hopscotch::sim {
namespace {

using core::JointVector;

model::RobotParameters hector() {
  return model::RobotParameters::load(std::string(HOPSCOTCH_SOURCE_DIR) +
                                      "/config/robots/hector.yaml");
}

core::JointCommand some_command() {
  core::JointCommand command;
  command.q = JointVector::Constant(0.2);
  command.dq = JointVector::Constant(-1.0);
  command.kp = JointVector::Constant(100.0);
  command.kd = JointVector::Constant(2.0);
  command.tau = JointVector::Constant(3.0);
  return command;
}

const DriveReading kReading{.q = JointVector::Constant(0.1), .dq = JointVector::Constant(0.5)};

TEST(Drive, ActiveAddsFeedForwardAndPdAtItsOwnReading) {
  core::JointCommand command = some_command();
  command.mode = core::DriveMode::active;
  // 3 + 100 (0.2 - 0.1) + 2 (-1 - 0.5)
  EXPECT_TRUE(drive_demand(command, kReading).isApprox(JointVector::Constant(10.0), 1e-12));
}

TEST(Drive, DampingOnlyBrakes) {
  core::JointCommand command = some_command();
  command.mode = core::DriveMode::damp;
  EXPECT_TRUE(drive_demand(command, kReading).isApprox(JointVector::Constant(-1.0), 1e-12));
}

TEST(Drive, IdleGivesNothing) {
  core::JointCommand command = some_command();
  command.mode = core::DriveMode::idle;
  EXPECT_TRUE(drive_demand(command, kReading).isZero(0.0));
}

TEST(Drive, MotorsOfBothLegsStayInsideTheirBoundsWhateverIsAsked) {
  constexpr double kRounding = 1e-9;  // [N·m]
  const model::RobotParameters robot = hector();
  Random random(7);
  for (int trial = 0; trial < 1000; ++trial) {
    const JointVector demand = 300.0 * random.uniform_vector<core::kJoints>();
    const JointVector speed = 25.0 * random.uniform_vector<core::kJoints>();
    const JointVector applied = limited_by_motors(robot, demand, speed, 1.0);
    for (const core::Leg leg : core::kAllLegs) {
      const int first = core::leg_offset(leg);
      const core::LegVector torque =
          model::motor_torques(applied.segment<core::kJointsPerLeg>(first));
      const core::LegVector rate = model::motor_speeds(speed.segment<core::kJointsPerLeg>(first));
      for (int j = 0; j < core::kJointsPerLeg; ++j) {
        const model::TorqueBounds bounds =
            model::torque_bounds(robot, static_cast<core::Joint>(j), rate[j]);
        EXPECT_GE(torque[j], bounds.lower - kRounding) << "trial " << trial;
        EXPECT_LE(torque[j], bounds.upper + kRounding) << "trial " << trial;
      }
    }
  }
}

TEST(Drive, WhatTheMotorsCanGivePassesUnchanged) {
  const JointVector demand = JointVector::Constant(5.0);
  const JointVector speed = JointVector::Constant(0.5);
  EXPECT_TRUE(limited_by_motors(hector(), demand, speed, 1.0).isApprox(demand, 1e-12));
}

TEST(Drive, WeakMotorsGiveProportionallyLess) {
  const JointVector demand = JointVector::Constant(500.0);
  const model::RobotParameters robot = hector();
  const JointVector full = limited_by_motors(robot, demand, JointVector::Zero(), 1.0);
  const JointVector weak = limited_by_motors(robot, demand, JointVector::Zero(), 0.8);
  EXPECT_TRUE(weak.isApprox(0.8 * full, 1e-12));
}

}  // namespace
}  // namespace hopscotch::sim
