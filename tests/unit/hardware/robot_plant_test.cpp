#include "hardware/robot_plant.hpp"

#include <gtest/gtest.h>

#include "hardware/range_check.hpp"
#include "tests/unit/hardware/drive_bench.hpp"

namespace hopscotch::hardware {
namespace {

using core::Reason;
using testing::DriveBench;

constexpr int kLeftKnee = 3;

class RobotPlantTest : public ::testing::Test {
 protected:
  RobotPlantTest() : home_(HomingConfig::load(testing::bus_file().section("homing")).joints()) {}

  void exchange(int times) {
    for (int i = 0; i < times; ++i) readings_ = plant_.exchange(testing::hold(home_));
  }
  void turn_on() {
    exchange(2);
    plant_.set_power(DrivePower::on);
    exchange(5);
    ASSERT_TRUE(plant_.powered());
    exchange(50);
    ASSERT_EQ(plant_.fault().reason, Reason::none);
  }
  /// Exchanges until there is a fault; -1 when none comes.
  int exchanges_to_fault(int most) {
    for (int i = 1; i <= most; ++i) {
      exchange(1);
      if (plant_.fault().reason != Reason::none) return i;
    }
    return -1;
  }

  BusTopology topology_ = testing::shipped_topology();
  DriveBench bench_{topology_};
  core::JointVector home_;
  RobotPlant plant_{testing::shipped_plant_config(), topology_, testing::hector(), bench_.ports()};
  core::SensorReadings readings_;
};

TEST_F(RobotPlantTest, ReadsJointsWithoutTurningAnythingOn) {
  exchange(2);
  EXPECT_TRUE(readings_.q.isApprox(home_, 1e-3));  // a code is 0.4 mrad
  for (int joint = 0; joint < core::kJoints; ++joint) {
    EXPECT_FALSE(bench_.drive(joint).in_motor_mode());
  }
  EXPECT_EQ(plant_.fault().reason, Reason::none);
}

TEST_F(RobotPlantTest, StampIsThatOfTheMeasurement) {
  exchange(2);
  const core::Stamp sent = bench_.now();
  exchange(1);
  EXPECT_EQ(readings_.stamp, sent);
}

TEST_F(RobotPlantTest, TorquesAtTheJointsAreThoseAskedFor) {
  turn_on();
  core::JointCommand command = testing::hold(home_);
  command.q = home_ + core::JointVector::Constant(0.05);
  command.dq.setConstant(0.2);
  command.tau << 3, -2, 5, 8, -4, -3, 2, -5, -8, 4;
  const JointStates before = bench_.joints();
  static_cast<void>(plant_.exchange(command));
  core::JointVector wanted = command.tau + command.kp.cwiseProduct(command.q - before.q) +
                             command.kd.cwiseProduct(command.dq - before.dq);
  // The drives' demand at the shafts as they were when the command was made.
  ShaftStates shafts = shaft_states(topology_, before);
  for (int joint = 0; joint < core::kJoints; ++joint) {
    const auto i = static_cast<std::size_t>(joint);
    const DriveSetpoint& setpoint = bench_.drive(joint).setpoint();
    shafts.torque[i] = setpoint.torque + setpoint.kp * (setpoint.position - shafts.position[i]) +
                       setpoint.kd * (setpoint.speed - shafts.speed[i]);
  }
  const core::JointVector given = joint_states(topology_, shafts).tau;
  constexpr double kRounding =
      0.25;  // of codes of position, speed and torque, times the gains [Nm]
  EXPECT_LT((given - wanted).cwiseAbs().maxCoeff(), kRounding) << given.transpose();
}

TEST_F(RobotPlantTest, EnablesHoldsAndTurnsOff) {
  turn_on();
  exchange(300);
  EXPECT_TRUE(bench_.joints().q.isApprox(home_, 0.01));
  EXPECT_EQ(plant_.counters().lost_replies, 0U);
  plant_.set_power(DrivePower::off);
  exchange(2);
  EXPECT_FALSE(bench_.drive(kLeftKnee).in_motor_mode());
}

TEST_F(RobotPlantTest, OneLostReplyHoldsTheLastReading) {
  turn_on();
  bench_.bus(1).lose_answers(1);
  exchange(20);
  EXPECT_EQ(plant_.counters().lost_replies, 1U);
  EXPECT_EQ(plant_.fault().reason, Reason::none);
  EXPECT_TRUE(readings_.q.allFinite());
}

TEST_F(RobotPlantTest, SilentDriveIsAFaultAfterThreeExchangesOnTheGround) {
  turn_on();
  bench_.drive(kLeftKnee).defects().silent = true;
  EXPECT_EQ(exchanges_to_fault(10), 3);
  EXPECT_EQ(plant_.fault().reason, Reason::drive_silent);
  EXPECT_EQ(plant_.fault().joint, kLeftKnee);
  EXPECT_EQ(describe(plant_.fault(), topology_), "left_knee (drive 4 on can1) does not answer");
}

TEST_F(RobotPlantTest, SilentDriveInFlightIsAFaultAfterFiveExchanges) {
  turn_on();
  plant_.notify_phase(core::RobotPhase::flight);
  bench_.drive(kLeftKnee).defects().silent = true;
  EXPECT_EQ(exchanges_to_fault(10), 5);
}

TEST_F(RobotPlantTest, OverTemperatureIsAFaultThatNamesTheDrive) {
  turn_on();
  bench_.drive(kLeftKnee).defects().fault = DriveFault::over_temperature;
  EXPECT_GT(exchanges_to_fault(3), 0);
  EXPECT_EQ(plant_.fault().reason, Reason::drive_fault);
  EXPECT_EQ(plant_.fault().drive, DriveFault::over_temperature);
}

TEST_F(RobotPlantTest, HotDriveIsAFaultBeforeItTripsItself) {
  turn_on();
  bench_.drive(kLeftKnee).defects().temperature_degC = 95.0;
  EXPECT_GT(exchanges_to_fault(3), 0);
  EXPECT_EQ(plant_.fault().reason, Reason::drive_fault);
}

TEST_F(RobotPlantTest, DriveThatDropsOutIsNotTurnedOnAgain) {
  turn_on();
  bench_.drive(kLeftKnee).defects().fault = DriveFault::under_voltage;
  exchange(3);
  bench_.drive(kLeftKnee).defects().fault = DriveFault::none;
  exchange(20);
  EXPECT_FALSE(bench_.drive(kLeftKnee).in_motor_mode());
}

TEST_F(RobotPlantTest, SwappedReplyIdentifiersAreAFaultBeforeAnythingMoves) {
  bench_.drive(3).defects().reply_id = topology_.drives[4].reply_id;
  bench_.drive(4).defects().reply_id = topology_.drives[3].reply_id;
  plant_.set_power(DrivePower::on);
  EXPECT_EQ(exchanges_to_fault(10), 3);
  EXPECT_FALSE(plant_.powered());
  EXPECT_TRUE(std::isnan(readings_.q(kLeftKnee)));  // never mistaken for the ankle
}

TEST_F(RobotPlantTest, BusOffIsLatchedAndNamesTheBus) {
  turn_on();
  bench_.bus(2).force_bus_off();
  EXPECT_EQ(exchanges_to_fault(3), 1);
  EXPECT_EQ(plant_.fault().reason, Reason::bus_fault);
  EXPECT_EQ(plant_.fault().bus, 2);
}

TEST_F(RobotPlantTest, CutWireIsAFaultOfTheBusWithinTwoExchanges) {
  turn_on();
  bench_.bus(1).cut();
  const int exchanges = exchanges_to_fault(5);
  EXPECT_GT(exchanges, 0);
  EXPECT_LE(exchanges, 2);
  EXPECT_EQ(plant_.fault().reason, Reason::bus_fault);
}

TEST_F(RobotPlantTest, FullQueueIsAFaultAtOnce) {
  BusModelOptions short_queue;
  short_queue.queue = 2;  // three drives on the first bus
  DriveBench bench(topology_, short_queue);
  RobotPlant plant(testing::shipped_plant_config(), topology_, testing::hector(), bench.ports());
  plant.set_power(DrivePower::on);
  static_cast<void>(plant.exchange({}));
  EXPECT_EQ(plant.fault().reason, Reason::bus_fault);
  EXPECT_EQ(plant.counters().not_sent, 2U);  // one on each bus of three
}

TEST_F(RobotPlantTest, StuckEncoderIsFoundWhileTheJointShouldMove) {
  turn_on();
  bench_.drive(kLeftKnee).defects().encoder_stuck = true;
  int exchanges = 0;
  for (; exchanges < 100 && plant_.fault().reason == Reason::none; ++exchanges) {
    core::JointCommand command = testing::hold(home_);
    command.dq(kLeftKnee) = -3.0;
    command.q(kLeftKnee) -= 3.0e-3 * exchanges;
    command.dq(kLeftKnee + 1) = 3.0;  // the ankle's motor stands still
    command.q(kLeftKnee + 1) += 3.0e-3 * exchanges;
    static_cast<void>(plant_.exchange(command));
  }
  EXPECT_EQ(plant_.fault().reason, Reason::encoder_stuck);
  EXPECT_EQ(plant_.fault().joint, kLeftKnee);
  EXPECT_LT(exchanges, 30);
}

TEST_F(RobotPlantTest, RobotAtRestHasNoStuckEncoder) {
  turn_on();
  exchange(3000);
  EXPECT_EQ(plant_.fault().reason, Reason::none);
}

TEST_F(RobotPlantTest, SilentImuIsAFault) {
  turn_on();
  bench_.imu_lost = true;
  const int exchanges = exchanges_to_fault(10);
  EXPECT_EQ(plant_.fault().reason, Reason::imu_lost);
  EXPECT_EQ(exchanges, 6);  // more than 5 ms old
}

TEST_F(RobotPlantTest, NoiseOnTheWireIsRepeatedByTheHostAndLosesAnswers) {
  BusModelOptions noisy;
  noisy.error_share = 0.01;
  DriveBench bench(topology_, noisy);
  RobotPlant plant(testing::shipped_plant_config(), topology_, testing::hector(), bench.ports());
  plant.set_power(DrivePower::on);
  for (int i = 0; i < 1000; ++i) static_cast<void>(plant.exchange(testing::hold(home_)));
  EXPECT_EQ(plant.fault().reason, Reason::none) << describe(plant.fault(), topology_);
  EXPECT_GT(plant.counters().lost_replies, 50U);  // of 10000 answers 1 %
  EXPECT_LT(plant.counters().lost_replies, 200U);
}

TEST_F(RobotPlantTest, NanCommandIsDampedAndNeverReachesTheWire) {
  turn_on();
  core::JointCommand command = testing::hold(home_);
  command.tau(2) = core::kNaN;
  static_cast<void>(plant_.exchange(command));
  for (int joint = 0; joint < core::kJoints; ++joint) {
    EXPECT_EQ(bench_.drive(joint).setpoint().kp, 0.0);
    EXPECT_GT(bench_.drive(joint).setpoint().kd, 0.0);
  }
  EXPECT_EQ(plant_.guard_counters().not_finite, 1U);
}

TEST_F(RobotPlantTest, RangesAreReadBackAndAWrongOneIsNamed) {
  const RangeCheckResult good = check_ranges(topology_, bench_.ports());
  EXPECT_EQ(good.problem, "");
  EXPECT_EQ(good.read, core::kJoints);
  bench_.drive(kLeftKnee).defects().torque_max = 18.0;
  const RangeCheckResult bad = check_ranges(topology_, bench_.ports());
  EXPECT_NE(bad.problem.find("left_knee is set to a torque range of 18"), std::string::npos)
      << bad.problem;
}

TEST_F(RobotPlantTest, OtherFamiliesWorkButCannotTellTheirRanges) {
  for (const char* name : {"ak10-9", "mini-cheetah"}) {
    BusTopology topology = topology_;
    for (DriveMount& drive : topology.drives) {
      drive.family = DriveFamily::load(testing::kConfigFolder + "drives/" + name + ".yaml");
    }
    DriveBench bench(topology);
    EXPECT_EQ(check_ranges(topology, bench.ports()).cannot_tell, core::kJoints);
    RobotPlant plant(testing::shipped_plant_config(), topology, testing::hector(), bench.ports());
    plant.set_power(DrivePower::on);
    for (int i = 0; i < 500; ++i) static_cast<void>(plant.exchange(testing::hold(home_)));
    EXPECT_EQ(plant.fault().reason, Reason::none) << describe(plant.fault(), topology);
    EXPECT_TRUE(bench.joints().q.isApprox(home_, 0.01)) << name;
  }
}

/// A million frames of anything, on the reply identifiers above all.
TEST_F(RobotPlantTest, GarbageFramesNeverBreakIt) {
  turn_on();
  constexpr int kFrames = 1'000'000;
  constexpr std::uint64_t kSeed = 20261122;
  RecordProperty("seed", std::to_string(kSeed));
  std::uint64_t random = kSeed;
  const auto next = [&random] {
    return random = random * 6364136223846793005ULL + 1442695040888963407ULL;
  };
  int left = kFrames;
  PlantPorts ports = bench_.ports();
  const auto inner = ports.buses[0].receive;
  ports.buses[0].receive = [&](std::span<CanEvent> events) {
    std::size_t count = inner(events);
    for (; count < events.size() && left > 0; ++count, --left) {
      const std::uint64_t bits = next();
      CanEvent& event = events[count];
      event = {};
      event.kind = (bits >> 60U) == 0 ? CanEvent::Kind::error : CanEvent::Kind::received;
      event.frame.id = static_cast<std::uint32_t>((bits >> 8U) % 3 == 0 ? (bits >> 16U) & 0x7FFU
                                                                        : 33U + (bits >> 16U) % 3);
      event.frame.size = static_cast<std::uint8_t>((bits >> 32U) % 3 == 0 ? (bits >> 40U) % 9 : 8);
      const std::uint64_t data = next();
      for (std::size_t i = 0; i < 8; ++i)
        event.frame.data[i] = static_cast<std::uint8_t>(data >> (8 * i));
    }
    return count;
  };
  RobotPlant plant(testing::shipped_plant_config(), topology_, testing::hector(), ports);
  plant.set_power(DrivePower::on);
  while (left > 0) {
    const core::SensorReadings readings = plant.exchange(testing::hold(home_));
    ASSERT_TRUE(readings.q.allFinite() || plant.counters().exchanges < 3);
  }
  // Whatever came in, what went out stayed within the guard, and garbage is a fault in the end.
  EXPECT_NE(plant.fault().reason, Reason::none);
  EXPECT_GT(plant.counters().malformed, 100'000U);
  EXPECT_GT(plant.counters().wrong_sender, 100'000U);
}

}  // namespace
}  // namespace hopscotch::hardware
