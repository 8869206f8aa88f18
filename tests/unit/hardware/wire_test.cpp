// The parts that RobotPlant is made of, one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hardware/can_bus.hpp"
#include "model/motor.hpp"
#include "tests/unit/hardware/drive_bench.hpp"

namespace hopscotch::hardware {
namespace {

using testing::DriveBench;

TEST(DriveMap, JointsSurviveTheWayToTheShaftsAndBack) {
  const BusTopology topology = testing::shipped_topology();
  JointStates joints;
  joints.q.setLinSpaced(-0.4, 0.7);
  joints.dq.setLinSpaced(3.0, -5.0);
  joints.tau.setLinSpaced(-20.0, 20.0);
  const JointStates back = joint_states(topology, shaft_states(topology, joints));
  EXPECT_TRUE(back.q.isApprox(joints.q, 1e-12));
  EXPECT_TRUE(back.dq.isApprox(joints.dq, 1e-12));
  EXPECT_TRUE(back.tau.isApprox(joints.tau, 1e-12));
}

TEST(DriveMap, PowerIsTheSameOnBothSides) {
  const BusTopology topology = testing::shipped_topology();
  JointStates joints;
  joints.q.setZero();
  joints.dq.setLinSpaced(3.0, -5.0);
  joints.tau.setLinSpaced(-20.0, 21.0);
  const ShaftStates shafts = shaft_states(topology, joints);
  double power = 0.0;
  for (std::size_t i = 0; i < core::kJoints; ++i) power += shafts.torque[i] * shafts.speed[i];
  EXPECT_NEAR(power, joints.tau.dot(joints.dq), 1e-9);
}

TEST(DriveMap, AnkleAloneTurnsTheAnkleMotorOnly) {
  BusTopology topology = testing::shipped_topology();
  JointStates joints{.q = core::JointVector::Zero(),
                     .dq = core::JointVector::Zero(),
                     .tau = core::JointVector::Zero()};
  joints.q(3) = 0.3;  // the knee takes both along
  const ShaftStates shafts = shaft_states(topology, joints);
  EXPECT_DOUBLE_EQ(shafts.position[3], 0.6);  // through its 2:1 belt
  EXPECT_DOUBLE_EQ(shafts.position[4], 0.3);
}

TEST(DriveMap, DampingAlwaysTakesEnergy) {
  const BusTopology topology = testing::shipped_topology();
  core::JointCommand command;
  command.mode = core::DriveMode::damp;
  command.kd.setConstant(2.0);
  JointStates joints;
  joints.q.setConstant(0.2);
  joints.dq << 1, -2, 3, -8, 9, 0, 1, 2, 5, -5;
  joints.tau.setZero();
  ShaftStates shafts = shaft_states(topology, joints);
  // The reading that the host has may be wrong altogether: here it is all zero.
  const auto setpoints =
      drive_setpoints(topology, command, core::JointVector::Zero(), core::JointVector::Zero());
  double power = 0.0;
  for (std::size_t i = 0; i < core::kJoints; ++i) {
    EXPECT_EQ(setpoints[i].kp, 0.0);
    const double torque =
        setpoints[i].torque + setpoints[i].kd * (setpoints[i].speed - shafts.speed[i]);
    power += torque * shafts.speed[i];
  }
  EXPECT_LT(power, -1.0);
}

TEST(MotorProtocol, RepliesOfAllLayoutsSurviveTheWire) {
  for (const char* name : {"dm8009", "ak10-9", "mini-cheetah"}) {
    const DriveFamily family =
        DriveFamily::load(testing::kConfigFolder + "drives/" + name + ".yaml");
    DriveReply sent;
    sent.drive_id = 7;
    sent.position = -1.234;
    sent.speed = 5.6;
    sent.torque = -7.8;
    sent.temperature_degC = 41.0;
    sent.rotor_temperature_degC = 55.0;
    sent.supply = 24.0;
    sent.enabled = true;
    DriveReply got;
    ASSERT_EQ(decode_reply(family, encode_reply(family, 0x27, sent), got), DecodeStatus::ok)
        << name;
    EXPECT_EQ(got.drive_id, 7);
    EXPECT_NEAR(got.position, sent.position, family.position_max / 65535.0);
    EXPECT_NEAR(got.speed, sent.speed, family.speed_max / 4095.0);
    EXPECT_NEAR(got.torque, sent.torque, family.torque_max / 4095.0);
    EXPECT_EQ(got.fault, DriveFault::none);
  }
}

TEST(MotorProtocol, RegistersAreReadAsTheDrivesWriteThem) {
  // The maker's example: ask drive 5 for its torque range.
  const CanFrame request = encode_register_request(5, DriveRegister::torque_max);
  EXPECT_EQ(request.id, 0x7FFU);
  const std::array<std::uint8_t, 8> wanted{5, 0, 0x33, 0x17, 0, 0, 0, 0};
  EXPECT_EQ(request.data, wanted);
  const CanFrame answer = encode_register_answer(
      0x25, {.drive_id = 5, .which = DriveRegister::torque_max, .value = 54.0});
  const std::array<std::uint8_t, 8> bits{5, 0, 0x33, 0x17, 0x00, 0x00, 0x58, 0x42};  // 54.0f
  EXPECT_EQ(answer.data, bits);
  const auto read = decode_register(answer);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->value, 54.0);
}

TEST(EmulatedDrive, GoesLimpWhenCommandsStayAway) {
  const BusTopology topology = testing::shipped_topology();
  for (const char* name : {"dm8009", "ak10-9"}) {
    DriveMount mount = topology.drives[0];
    mount.family = DriveFamily::load(testing::kConfigFolder + "drives/" + name + ".yaml");
    EmulatedDrive drive(mount, 0.025);
    const ShaftState shaft{.position = 0.5};
    CanFrame frame;
    const auto at = [](double seconds) { return core::Stamp::from_seconds(seconds); };
    drive.receive(*encode_special(mount.family, mount.id, SpecialCommand::enter_motor_mode), shaft,
                  at(0));
    ASSERT_EQ(encode_setpoint(mount.family, mount.id, {.kp = 20.0}, frame), EncodeStatus::exact);
    drive.receive(frame, shaft, at(0.001));
    EXPECT_NEAR(drive.torque(shaft, at(0.025)), -10.0, 0.1);
    EXPECT_EQ(drive.torque(shaft, at(0.0265)), 0.0);
    // Special commands do not feed the watchdog; the next set-point revives an AK, a Damiao not.
    drive.receive(frame, shaft, at(0.03));
    const bool latches = mount.family.reply == ReplyLayout::damiao;
    EXPECT_EQ(drive.torque(shaft, at(0.031)) == 0.0, latches) << name;
  }
}

TEST(EmulatedDrive, HearsOnlyItsOwnIdentifier) {
  const BusTopology topology = testing::shipped_topology();
  EmulatedDrive drive(topology.drives[0], 0.025);
  const auto& other = topology.drives[1];
  EXPECT_FALSE(drive.receive(
      *encode_special(other.family, other.id, SpecialCommand::enter_motor_mode), {}, {}));
  EXPECT_FALSE(drive.in_motor_mode());
}

TEST(BusModel, FrameBitsAreBetweenTheBoundsOfTheStandard) {
  CanFrame zeros{.id = 0, .size = 8};  // a run of zeros: stuffed most
  CanFrame mixed{.id = 0x555, .size = 8};
  mixed.data.fill(0x55);
  EXPECT_GE(frame_bits(zeros), 125);
  EXPECT_LE(frame_bits(zeros), 135);
  EXPECT_GE(frame_bits(mixed), 111);
  EXPECT_LE(frame_bits(mixed), 114);
}

TEST(BusModel, LowestIdentifierGoesFirst) {
  BusModel bus({.interface_name = "can0", .bit_rate = 1e6}, {});
  const std::array<CanFrame, 2> frames{CanFrame{.id = 5, .size = 8}, CanFrame{.id = 3, .size = 8}};
  ASSERT_EQ(bus.send(frames), 2U);
  // Drive 5 answers with 0x21 while the host still has 3 to send: the host's lower identifier wins.
  bus.advance(core::Stamp::from_seconds(0.001), [](const CanFrame& frame, core::Stamp) {
    return std::vector<CanFrame>{CanFrame{.id = 0x20 + frame.id, .size = 8}};
  });
  std::array<CanEvent, 8> events;
  ASSERT_EQ(bus.receive(events), 4U);
  EXPECT_EQ(events[0].frame.id, 5U);
  EXPECT_EQ(events[1].frame.id, 3U);
  EXPECT_EQ(events[2].frame.id, 0x23U);
  EXPECT_EQ(events[3].frame.id, 0x25U);
}

TEST(BusModel, AnswersWithOneIdentifierDestroyEachOther) {
  BusModel bus({.interface_name = "can0", .bit_rate = 1e6}, {});
  const std::array<CanFrame, 2> frames{CanFrame{.id = 1, .size = 8}, CanFrame{.id = 2, .size = 8}};
  ASSERT_EQ(bus.send(frames), 2U);
  bus.advance(core::Stamp::from_seconds(0.002), [](const CanFrame&, core::Stamp) {
    return std::vector<CanFrame>{CanFrame{.id = 0, .size = 6}, CanFrame{.id = 0, .size = 6}};
  });
  std::array<CanEvent, 8> events;
  const std::size_t count = bus.receive(events);
  const auto received =
      std::count_if(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(count),
                    [](const CanEvent& event) { return event.kind == CanEvent::Kind::received; });
  EXPECT_EQ(received, 0);
}

TEST(BusModel, CutWireMakesTheControllerPassiveAndFillsTheQueue) {
  BusModel bus({.interface_name = "can0", .bit_rate = 1e6}, {.queue = 4});
  bus.cut();
  const CanFrame frame{.id = 1, .size = 8};
  std::size_t taken = 0;
  for (int i = 0; i < 10; ++i) taken += bus.send({&frame, 1});
  EXPECT_EQ(taken, 4U);
  bus.advance(core::Stamp::from_seconds(0.01),
              [](const CanFrame&, core::Stamp) { return std::vector<CanFrame>{}; });
  EXPECT_GT(bus.send_error_counter(), 127);
  EXPECT_FALSE(bus.bus_off());  // a lonely controller does not go off: it is passive and repeats
}

TEST(BusModel, ControllerGoesOffTheBusUnderNoise) {
  BusModel bus({.interface_name = "can0", .bit_rate = 1e6}, {.error_share = 0.95});
  const CanFrame frame{.id = 1, .size = 8};
  bus.send({&frame, 1});
  for (int i = 1; i < 200 && !bus.bus_off(); ++i) {
    bus.send({&frame, 1});
    bus.advance(core::Stamp::from_seconds(0.001 * i),
                [](const CanFrame&, core::Stamp) { return std::vector<CanFrame>{}; });
  }
  EXPECT_TRUE(bus.bus_off());
  EXPECT_EQ(bus.send({&frame, 1}), 0U);
}

TEST(CanBus, ErrorFramesAreReadAsLinuxWritesThem) {
  const std::array<std::uint8_t, 8> none{};
  EXPECT_TRUE(decode_bus_errors(0x20000040, none).bus_off);
  EXPECT_TRUE(decode_bus_errors(0x20000020, none).no_acknowledge);
  EXPECT_TRUE(decode_bus_errors(0x20000088, none).protocol);
  EXPECT_TRUE(decode_bus_errors(0x20000100, none).restarted);
  std::array<std::uint8_t, 8> controller{};
  controller[1] = 0x20;  // sender passive
  EXPECT_TRUE(decode_bus_errors(0x20000004, controller).passive);
  controller[1] = 0x01;
  EXPECT_TRUE(decode_bus_errors(0x20000004, controller).overflow);
  EXPECT_EQ(decode_bus_errors(0x20000000, none), BusErrors{});
}

TEST(Homing, HomePoseIsFineAndAWholeTurnIsNot) {
  const HomingConfig config = HomingConfig::load(testing::bus_file().section("homing"));
  const model::RobotParameters robot = testing::hector();
  core::JointVector q = config.joints();
  EXPECT_EQ(homing_problem(config, robot, q), "");
  q(3) += std::numbers::pi;  // the knee's drive restarted one turn on: half a turn at the joint
  EXPECT_NE(homing_problem(config, robot, q).find("left_knee reads 1.317 rad, outside"),
            std::string::npos)
      << homing_problem(config, robot, q);
  q = config.joints();
  q(7) = core::kNaN;
  EXPECT_EQ(homing_problem(config, robot, q), "right_hip_pitch has not answered");
  q = config.joints();
  q(2) += 0.3;
  EXPECT_NE(
      homing_problem(config, robot, q).find("left_hip_pitch reads 0.967 rad, but home is 0.667"),
      std::string::npos);
}

core::SensorReadings readings(double knee_torque, double speed) {
  core::SensorReadings readings;
  readings.tau.setZero();
  readings.tau(3) = knee_torque;
  readings.dq.setConstant(speed);
  return readings;
}

core::Stamp at(double seconds) {
  return core::Stamp::from_seconds(seconds);
}

TEST(SoftStop, OnTheGroundItDampsUntilStillThenLetsGo) {
  SoftStop stop(SoftStopConfig::load(testing::bus_file().section("soft_stop")));
  stop.begin_on_ground(at(1.0));
  EXPECT_EQ(stop.command(at(1.0), readings(0, 3.0)).mode, core::DriveMode::damp);
  EXPECT_EQ(stop.command(at(2.0), readings(0, 3.0)).mode, core::DriveMode::damp);
  EXPECT_EQ(stop.command(at(2.05), readings(0, 0.1)).mode, core::DriveMode::damp);
  EXPECT_EQ(stop.command(at(2.2), readings(0, 0.1)).mode, core::DriveMode::idle);
  EXPECT_EQ(stop.stage(), SoftStop::Stage::limp);
}

TEST(SoftStop, InFlightItTakesTheLandingPostureUntilAKneeIsLoaded) {
  SoftStop stop(SoftStopConfig::load(testing::bus_file().section("soft_stop")));
  const core::JointVector posture = core::JointVector::Constant(0.2);
  stop.begin_in_flight(at(0.0), posture);
  const core::JointCommand command = stop.command(at(0.01), readings(1.0, 3.0));
  EXPECT_EQ(command.mode, core::DriveMode::active);
  EXPECT_EQ(command.q, posture);
  EXPECT_GT(command.kp(3), 0.0);
  for (int i = 0; i < 2; ++i) {  // two loaded readings may be noise, three are the ground
    EXPECT_EQ(stop.command(at(0.2), readings(20.0, 3.0)).mode, core::DriveMode::active);
  }
  EXPECT_EQ(stop.command(at(0.2), readings(20.0, 3.0)).mode, core::DriveMode::damp);
}

TEST(SoftStop, GivesUpWaitingForTheGround) {
  SoftStop stop(SoftStopConfig::load(testing::bus_file().section("soft_stop")));
  stop.begin_in_flight(at(0.0), core::JointVector::Zero());
  EXPECT_EQ(stop.command(at(0.9), readings(0.0, 3.0)).mode, core::DriveMode::damp);
}

TEST(SoftStop, UnknownSpeedsAreNotStillnessButDampingEndsAllTheSame) {
  SoftStop stop(SoftStopConfig::load(testing::bus_file().section("soft_stop")));
  stop.begin_on_ground(at(0.0));
  EXPECT_EQ(stop.command(at(2.5), core::SensorReadings{}).mode, core::DriveMode::damp);
  EXPECT_EQ(stop.command(at(3.0), core::SensorReadings{}).mode, core::DriveMode::idle);
}

ImuSample sample(std::uint64_t time) {
  return {.time_ns = time, .rate = {0.1, -0.2, 0.3}, .force = {0.5, -0.25, 9.75}};
}

TEST(Imu, MessagesAreFoundBehindGarbageAndFalseStarts) {
  ImuDecoder decoder;
  std::vector<std::uint8_t> stream{0x00, 0xFA, 0x01, 0x21, 0xFA, 0xFA, 0x01};
  const auto message = encode_imu(sample(42));
  stream.insert(stream.end(), message.begin(), message.end());
  std::optional<ImuSample> got;
  for (const std::uint8_t byte : stream) {
    if (const auto found = decoder.feed({&byte, 1})) got = found;
  }
  ASSERT_TRUE(got);
  EXPECT_EQ(got->time_ns, 42U);
  EXPECT_TRUE(got->rate.isApprox(sample(0).rate, 1e-6));
  EXPECT_TRUE(got->force.isApprox(sample(0).force, 1e-6));
}

TEST(Imu, ChangedBitIsRejectedAndTheNextMessageIsRead) {
  ImuDecoder decoder;
  auto broken = encode_imu(sample(1));
  broken[20] ^= 0x10;
  EXPECT_FALSE(decoder.feed(broken));
  EXPECT_EQ(decoder.rejected(), 1U);
  const auto good = decoder.feed(encode_imu(sample(2)));
  ASSERT_TRUE(good);
  EXPECT_EQ(good->time_ns, 2U);
}

TEST(Imu, NewestOfSeveralMessagesCounts) {
  std::vector<std::uint8_t> stream;
  for (std::uint64_t time = 1; time <= 3; ++time) {
    const auto message = encode_imu(sample(time));
    stream.insert(stream.end(), message.begin(), message.end());
  }
  ImuDecoder decoder;
  EXPECT_EQ(decoder.feed(stream)->time_ns, 3U);
  EXPECT_EQ(decoder.messages(), 3U);
}

TEST(Imu, SerialLineBringsTheMessageIntoTrunkAxes) {
  const std::string link = ::testing::TempDir() + "hopscotch-imu-test";
  SerialImuEnd far_end(link);
  ImuSetup setup{.device = link, .baud = 921600, .R_BI = Eigen::Matrix3d::Identity()};
  setup.R_BI << 0, 1, 0, -1, 0, 0, 0, 0, 1;  // turned by a quarter about the vertical
  SerialImu imu(setup);
  EXPECT_FALSE(imu.poll());
  far_end.write(sample(5));
  std::optional<ImuSample> got = imu.poll();
  ASSERT_TRUE(got);
  EXPECT_NEAR(got->rate.x(), -0.2, 1e-6);
  EXPECT_NEAR(got->rate.y(), -0.1, 1e-6);
}

TEST(Imu, MissingDeviceIsNamedWithTheFix) {
  try {
    const SerialImu imu({.device = "/dev/no-such-imu", .baud = 921600});
    FAIL() << "opened";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/no-such-imu"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("fix:"), std::string::npos);
  }
}

}  // namespace
}  // namespace hopscotch::hardware
