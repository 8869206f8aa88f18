#include "hardware/command_guard.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <random>

#include "core/robot_state.hpp"
#include "model/motor.hpp"

namespace hopscotch::hardware {
namespace {

using core::DriveMode;
using core::JointCommand;
using core::JointVector;

class CommandGuardTest : public ::testing::Test {
 protected:
  /// A harmless standing command; readings equal set-points.
  static JointCommand standing() {
    JointCommand command;
    command.stamp = core::Stamp::from_seconds(1.25);
    command.mode = DriveMode::active;
    command.q << 0, 0, 0.7, -1.4, 0.7, 0, 0, 0.7, -1.4, 0.7;
    command.kp.setConstant(100.0);
    command.kd.setConstant(2.0);
    command.tau.setConstant(1.0);
    return command;
  }

  GuardVerdict filter(const JointCommand& wanted) {
    return guard_.filter(wanted, standing().q, JointVector::Zero(), safe_);
  }

  void expect_damped() const {
    EXPECT_EQ(safe_.mode, DriveMode::damp);
    EXPECT_TRUE(safe_.tau.isZero(0.0));
    EXPECT_TRUE(safe_.kp.isZero(0.0));
    EXPECT_EQ(safe_.kd, JointVector::Constant(config_.damping));
    EXPECT_EQ(safe_.stamp, standing().stamp);
  }

  CommandGuardConfig config_{.kp_max = 200.0, .kd_max = 5.0, .overshoot_max = 0.2, .damping = 1.5};
  model::RobotParameters robot_ = model::RobotParameters::load(
      std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config" / "robots" / "hector.yaml");
  CommandGuard guard_{config_, robot_};
  JointCommand safe_;
};

TEST_F(CommandGuardTest, HarmlessCommandPassesBitForBit) {
  EXPECT_EQ(filter(standing()), GuardVerdict::passed);
  EXPECT_EQ(safe_.q, standing().q);
  EXPECT_EQ(safe_.tau, standing().tau);
  EXPECT_EQ(safe_.mode, DriveMode::active);
}

TEST_F(CommandGuardTest, EveryNumberThatIsNotFiniteDamps) {
  for (const double bad : {core::kNaN, std::numeric_limits<double>::infinity()}) {
    for (JointVector JointCommand::*field : {&JointCommand::q, &JointCommand::dq, &JointCommand::kp,
                                             &JointCommand::kd, &JointCommand::tau}) {
      JointCommand wanted = standing();
      (wanted.*field)(7) = bad;
      EXPECT_EQ(filter(wanted), GuardVerdict::damped);
      expect_damped();
    }
  }
  EXPECT_EQ(guard_.counters().not_finite, 10U);
}

TEST_F(CommandGuardTest, ReadingThatIsNotFiniteDamps) {
  JointVector q = standing().q;
  q(2) = core::kNaN;
  EXPECT_EQ(guard_.filter(standing(), q, JointVector::Zero(), safe_), GuardVerdict::damped);
  expect_damped();
}

TEST_F(CommandGuardTest, JointFarBeyondItsRangeDamps) {
  const int knee = core::joint_index(core::Leg::right, core::Joint::knee);
  const double upper = model::joint_range(robot_, core::Leg::right, core::Joint::knee).upper;
  JointVector q = standing().q;
  q(knee) = upper + 0.9 * config_.overshoot_max;
  JointCommand wanted = standing();
  wanted.kp.setZero();  // so that nothing else acts
  EXPECT_EQ(guard_.filter(wanted, q, JointVector::Zero(), safe_), GuardVerdict::passed);
  q(knee) = upper + 1.1 * config_.overshoot_max;
  EXPECT_EQ(guard_.filter(wanted, q, JointVector::Zero(), safe_), GuardVerdict::damped);
  expect_damped();
  EXPECT_EQ(guard_.counters().overshoot, 1U);
}

TEST_F(CommandGuardTest, SetpointsStayInJointRangeAndSpeed) {
  JointCommand wanted = standing();
  wanted.kp.setZero();
  wanted.kd.setZero();
  wanted.q.setConstant(9.0);
  wanted.dq.setConstant(-99.0);
  EXPECT_EQ(filter(wanted), GuardVerdict::limited);
  for (const core::Leg leg : core::kAllLegs) {
    for (int i = 0; i < core::kJointsPerLeg; ++i) {
      const auto joint = static_cast<core::Joint>(i);
      const int at = core::joint_index(leg, joint);
      EXPECT_EQ(safe_.q(at), model::joint_range(robot_, leg, joint).upper);
      EXPECT_EQ(safe_.dq(at), -robot_.motors[core::index(joint)].speed_max);
    }
  }
  EXPECT_EQ(guard_.counters().position, 10U);
  EXPECT_EQ(guard_.counters().speed, 10U);
}

TEST_F(CommandGuardTest, GainsStayBetweenZeroAndTheirMaximum) {
  JointCommand wanted = standing();
  wanted.kp(0) = -5.0;
  wanted.kp(1) = 1e6;
  wanted.kd(2) = 1e6;
  EXPECT_EQ(filter(wanted), GuardVerdict::limited);
  EXPECT_EQ(safe_.kp(0), 0.0);
  EXPECT_EQ(safe_.kp(1), config_.kp_max);
  EXPECT_EQ(safe_.kd(2), config_.kd_max);
  EXPECT_EQ(guard_.counters().gain, 3U);
}

TEST_F(CommandGuardTest, DampingGainsAreLimitedToo) {
  JointCommand wanted;
  wanted.mode = DriveMode::damp;
  wanted.kd.setConstant(99.0);
  EXPECT_EQ(filter(wanted), GuardVerdict::limited);
  EXPECT_EQ(safe_.kd, JointVector::Constant(config_.kd_max));
  EXPECT_EQ(safe_.mode, DriveMode::damp);
}

TEST_F(CommandGuardTest, IdlePasses) {
  EXPECT_EQ(filter(JointCommand{}), GuardVerdict::passed);
  EXPECT_EQ(safe_.mode, DriveMode::idle);
}

TEST_F(CommandGuardTest, NoDemandExceedsAMotorWhateverIsAsked) {
  constexpr unsigned kSeed = 3;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  constexpr double kRounding = 1e-9;  // [N·m], of sums of numbers up to 1e3
  for (int trial = 0; trial < 2000; ++trial) {
    JointCommand wanted = standing();
    JointVector dq;
    for (int i = 0; i < core::kJoints; ++i) {
      wanted.tau(i) = 300.0 * unit(random);
      wanted.q(i) += 0.5 * unit(random);
      dq(i) = 20.0 * unit(random);
    }
    EXPECT_NE(guard_.filter(wanted, standing().q, dq, safe_), GuardVerdict::damped);
    const JointVector torque = safe_.tau + safe_.kp.cwiseProduct(safe_.q - standing().q) +
                               safe_.kd.cwiseProduct(safe_.dq - dq);
    for (const core::Leg leg : core::kAllLegs) {
      const core::LegVector motors =
          model::motor_torques(torque.segment<core::kJointsPerLeg>(core::leg_offset(leg)));
      for (int i = 0; i < core::kJointsPerLeg; ++i) {
        EXPECT_LE(std::abs(motors(i)),
                  robot_.motors[static_cast<std::size_t>(i)].torque_max + kRounding)
            << "seed " << kSeed << " trial " << trial;
      }
    }
  }
  EXPECT_GT(guard_.counters().torque, 0U);
}

}  // namespace
}  // namespace hopscotch::hardware
