#include "hardware/motor_protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace hopscotch::hardware {
namespace {

using ::testing::ElementsAre;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The ranges of the reference vectors: P 12.5, V 45, KP 500, KD 5, T 54.
DriveFamily family_of(ReplyLayout reply) {
  DriveFamily family;
  family.name = "test";
  family.reply = reply;
  family.position_max = 12.5;
  family.speed_max = 45.0;
  family.torque_max = 54.0;
  family.kp_max = 500.0;
  family.kd_max = 5.0;
  family.supply_max = 40.0;
  return family;
}

const DriveFamily kFamily = family_of(ReplyLayout::damiao);

CanFrame frame_of(std::initializer_list<int> bytes) {
  CanFrame frame;
  frame.id = 0x21;
  for (const int byte : bytes) frame.data[frame.size++] = static_cast<std::uint8_t>(byte);
  return frame;
}

CanFrame encoded(const DriveSetpoint& setpoint) {
  CanFrame frame;
  EXPECT_NE(encode_setpoint(kFamily, 3, setpoint, frame), EncodeStatus::not_finite);
  return frame;
}

// Reference firmware truncates: its zero is 7F FF 7F F0 00 00 07 FF. Rounding to nearest, the zero
// lies exactly between two codes and goes up.
TEST(MotorProtocol, ZeroSetpointPacksToTheMiddleCodes) {
  const CanFrame frame = encoded({});
  EXPECT_EQ(frame.id, 3U);
  EXPECT_EQ(frame.size, 8);
  EXPECT_THAT(frame.data, ElementsAre(0x80, 0x00, 0x80, 0x00, 0x00, 0x00, 0x08, 0x00));
}

TEST(MotorProtocol, ReferenceSetpointPacksToTheNearestCodes) {
  // Before rounding: p 35388.9, v 1956.5, kp 1228.5, kd 1638, t 2426.7.
  const CanFrame frame =
      encoded({.position = 1.0, .speed = -2.0, .kp = 150.0, .kd = 2.0, .torque = 10.0});
  EXPECT_EQ(frame.data[0], 0x8A);
  EXPECT_EQ(frame.data[1], 0x3D);  // 35389
  EXPECT_EQ(frame.data[2] << 4 | frame.data[3] >> 4, 1957);
  EXPECT_EQ((frame.data[3] & 0xF) << 8 | frame.data[4], 1229);
  EXPECT_EQ(frame.data[5] << 4 | frame.data[6] >> 4, 1638);
  EXPECT_EQ((frame.data[6] & 0xF) << 8 | frame.data[7], 2427);
}

TEST(MotorProtocol, FrameOfTheReferenceFirmwareDecodesToItsSetpoint) {
  // Packed by truncation from p 1, v -2, kp 150, kd 2, t 10: each value is at most one step lower.
  const auto setpoint =
      decode_setpoint(kFamily, frame_of({0x8A, 0x3C, 0x7A, 0x44, 0xCC, 0x66, 0x69, 0x7A}));
  ASSERT_TRUE(setpoint.has_value());
  EXPECT_NEAR(setpoint->position, 1.0, 25.0 / 65535);
  EXPECT_NEAR(setpoint->speed, -2.0, 90.0 / 4095);
  EXPECT_NEAR(setpoint->kp, 150.0, 500.0 / 4095);
  EXPECT_NEAR(setpoint->kd, 2.0, 5.0 / 4095);
  EXPECT_NEAR(setpoint->torque, 10.0, 108.0 / 4095);
}

TEST(MotorProtocol, SetpointSurvivesTheWireWithinHalfAStep) {
  constexpr unsigned kSeed = 1;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  constexpr double kHalfStep = 0.5 * (1.0 + 1e-9);  // rounding of the comparison itself
  for (int trial = 0; trial < 10000; ++trial) {
    const DriveSetpoint sent{.position = 12.5 * unit(random),
                             .speed = 45.0 * unit(random),
                             .kp = 500.0 * std::abs(unit(random)),
                             .kd = 4.99 * std::abs(unit(random)),
                             .torque = 54.0 * unit(random)};
    const auto got = decode_setpoint(kFamily, encoded(sent));
    ASSERT_TRUE(got.has_value()) << "seed " << kSeed << " trial " << trial;
    EXPECT_NEAR(got->position, sent.position, kHalfStep * 25.0 / 65535);
    EXPECT_NEAR(got->speed, sent.speed, kHalfStep * 90.0 / 4095);
    EXPECT_NEAR(got->kp, sent.kp, kHalfStep * 500.0 / 4095);
    EXPECT_NEAR(got->kd, sent.kd, kHalfStep * 5.0 / 4095);
    EXPECT_NEAR(got->torque, sent.torque, kHalfStep * 108.0 / 4095);
  }
}

TEST(MotorProtocol, NothingAtFullScaleLooksLikeASpecialCommand) {
  for (const double torque : {53.85, 53.9, 53.95, 54.0, 1e9}) {
    const CanFrame frame =
        encoded({.position = 12.5, .speed = 45.0, .kp = 500.0, .kd = 5.0, .torque = torque});
    EXPECT_FALSE(special_command(frame).has_value()) << torque;
    EXPECT_EQ(frame.data[6] & 0xF0, 0xE0) << torque;
    EXPECT_TRUE(decode_setpoint(kFamily, frame).has_value()) << torque;
  }
}

TEST(MotorProtocol, NumbersOutsideTheirRangeGoToTheBound) {
  CanFrame frame;
  const DriveSetpoint wild{.position = 99.0, .speed = -99.0, .kp = -1.0, .kd = 0.0, .torque = -1e9};
  EXPECT_EQ(encode_setpoint(kFamily, 1, wild, frame), EncodeStatus::clamped);
  const auto got = decode_setpoint(kFamily, frame);
  ASSERT_TRUE(got.has_value());
  EXPECT_DOUBLE_EQ(got->position, 12.5);
  EXPECT_DOUBLE_EQ(got->speed, -45.0);
  EXPECT_DOUBLE_EQ(got->kp, 0.0);
  EXPECT_DOUBLE_EQ(got->torque, -54.0);
}

TEST(MotorProtocol, NumbersOnTheirBoundAreExact) {
  CanFrame frame;
  EXPECT_EQ(encode_setpoint(kFamily, 1, {.position = -12.5, .speed = 45.0, .kp = 500.0}, frame),
            EncodeStatus::exact);
}

TEST(MotorProtocol, NoFrameIsMadeOfNumbersThatAreNotFinite) {
  const CanFrame before = frame_of({1, 2, 3});
  for (const double bad : {core::kNaN, kInfinity, -kInfinity}) {
    for (const DriveSetpoint& setpoint :
         {DriveSetpoint{.position = bad}, DriveSetpoint{.speed = bad}, DriveSetpoint{.kp = bad},
          DriveSetpoint{.kd = bad}, DriveSetpoint{.torque = bad}}) {
      CanFrame frame = before;
      EXPECT_EQ(encode_setpoint(kFamily, 1, setpoint, frame), EncodeStatus::not_finite);
      EXPECT_EQ(frame.data, before.data);
      EXPECT_EQ(frame.id, before.id);
    }
  }
}

TEST(MotorProtocol, SpecialCommandsHaveTheirBytesAndAreRecognised) {
  for (const SpecialCommand command :
       {SpecialCommand::clear_error, SpecialCommand::enter_motor_mode,
        SpecialCommand::exit_motor_mode, SpecialCommand::set_zero}) {
    const std::optional<CanFrame> frame = encode_special(kFamily, 7, command);
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->id, 7U);
    EXPECT_EQ(frame->size, 8);
    EXPECT_EQ(special_command(*frame), command);
    EXPECT_FALSE(decode_setpoint(kFamily, *frame).has_value());
  }
  EXPECT_THAT(encode_special(kFamily, 7, SpecialCommand::enter_motor_mode)->data,
              ElementsAre(0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC));
}

TEST(MotorProtocol, OnlyDamiaoClearsErrors) {
  EXPECT_FALSE(
      encode_special(family_of(ReplyLayout::ak), 1, SpecialCommand::clear_error).has_value());
  EXPECT_TRUE(encode_special(family_of(ReplyLayout::ak), 1, SpecialCommand::set_zero).has_value());
}

TEST(MotorProtocol, AllOnesAndShortFramesAreNoSpecialCommand) {
  EXPECT_FALSE(
      special_command(frame_of({0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF})).has_value());
  EXPECT_FALSE(special_command(frame_of({0xFF, 0xFF, 0xFC})).has_value());
  EXPECT_FALSE(decode_setpoint(kFamily, frame_of({1, 2, 3})).has_value());
}

TEST(MotorReply, MiniCheetahHasPlaceAndTorqueOnly) {
  DriveReply reply;
  ASSERT_EQ(decode_reply(family_of(ReplyLayout::mini_cheetah),
                         frame_of({5, 0xFF, 0xFF, 0x00, 0x0F, 0xFF}), reply),
            DecodeStatus::ok);
  EXPECT_EQ(reply.drive_id, 5);
  EXPECT_DOUBLE_EQ(reply.position, 12.5);
  EXPECT_DOUBLE_EQ(reply.speed, -45.0);
  EXPECT_DOUBLE_EQ(reply.torque, 54.0);
  EXPECT_TRUE(std::isnan(reply.supply));
  EXPECT_TRUE(std::isnan(reply.temperature_degC));
  EXPECT_FALSE(reply.enabled.has_value());
  EXPECT_EQ(reply.fault, DriveFault::none);
}

TEST(MotorReply, MiddleCodesAreHalfAStepFromZero) {
  DriveReply reply;
  ASSERT_EQ(decode_reply(family_of(ReplyLayout::mini_cheetah),
                         frame_of({1, 0x80, 0x00, 0x80, 0x08, 0x00}), reply),
            DecodeStatus::ok);
  EXPECT_NEAR(reply.position, 0.5 * 25.0 / 65535, 1e-12);
  EXPECT_NEAR(reply.speed, 0.5 * 90.0 / 4095, 1e-12);
  EXPECT_NEAR(reply.torque, 0.5 * 108.0 / 4095, 1e-12);
}

TEST(MotorReply, NewMiniCheetahAddsTheSupplyVoltage) {
  DriveReply reply;
  ASSERT_EQ(decode_reply(family_of(ReplyLayout::mini_cheetah_supply),
                         frame_of({5, 0x80, 0, 0x80, 0x08, 0, 153}), reply),
            DecodeStatus::ok);
  EXPECT_NEAR(reply.supply, 24.0, 1e-9);
}

TEST(MotorReply, AkAddsTemperatureAndErrorCode) {
  DriveFamily family = family_of(ReplyLayout::ak);
  family.temperature_offset_degC = -40.0;
  DriveReply reply;
  ASSERT_EQ(decode_reply(family, frame_of({9, 0x80, 0, 0x80, 0x08, 0, 75, 2}), reply),
            DecodeStatus::ok);
  EXPECT_EQ(reply.drive_id, 9);
  EXPECT_EQ(reply.temperature_degC, 35.0);
  EXPECT_EQ(reply.fault, DriveFault::over_current);
}

TEST(MotorReply, DamiaoPacksStatusBesideTheId) {
  DriveReply reply;
  ASSERT_EQ(decode_reply(kFamily, frame_of({0x1A, 0x80, 0, 0x80, 0x08, 0, 41, 52}), reply),
            DecodeStatus::ok);
  EXPECT_EQ(reply.drive_id, 0xA);
  EXPECT_EQ(reply.enabled, true);
  EXPECT_EQ(reply.fault, DriveFault::none);
  EXPECT_EQ(reply.temperature_degC, 41.0);
  EXPECT_EQ(reply.rotor_temperature_degC, 52.0);
}

struct FaultCase {
  ReplyLayout layout;
  int code;
  DriveFault fault;
};

class MotorReplyFault : public ::testing::TestWithParam<FaultCase> {};

TEST_P(MotorReplyFault, HasItsMeaning) {
  const auto [layout, code, fault] = GetParam();
  CanFrame frame = frame_of({1, 0x80, 0, 0x80, 0x08, 0, 30, 30});
  if (layout == ReplyLayout::ak) frame.data[7] = static_cast<std::uint8_t>(code);
  if (layout == ReplyLayout::damiao) frame.data[0] = static_cast<std::uint8_t>(code << 4 | 1);
  DriveReply reply;
  ASSERT_EQ(decode_reply(family_of(layout), frame, reply), DecodeStatus::ok);
  EXPECT_EQ(reply.fault, fault);
}

INSTANTIATE_TEST_SUITE_P(
    Ak, MotorReplyFault,
    ::testing::Values(FaultCase{ReplyLayout::ak, 0, DriveFault::none},
                      FaultCase{ReplyLayout::ak, 1, DriveFault::over_temperature},
                      FaultCase{ReplyLayout::ak, 2, DriveFault::over_current},
                      FaultCase{ReplyLayout::ak, 3, DriveFault::over_voltage},
                      FaultCase{ReplyLayout::ak, 4, DriveFault::under_voltage},
                      FaultCase{ReplyLayout::ak, 5, DriveFault::encoder},
                      FaultCase{ReplyLayout::ak, 6, DriveFault::phase_unbalance},
                      FaultCase{ReplyLayout::ak, 7, DriveFault::unknown},
                      FaultCase{ReplyLayout::ak, 255, DriveFault::unknown}));

INSTANTIATE_TEST_SUITE_P(
    Damiao, MotorReplyFault,
    ::testing::Values(FaultCase{ReplyLayout::damiao, 0x0, DriveFault::none},
                      FaultCase{ReplyLayout::damiao, 0x1, DriveFault::none},
                      FaultCase{ReplyLayout::damiao, 0x5, DriveFault::unknown},
                      FaultCase{ReplyLayout::damiao, 0x8, DriveFault::over_voltage},
                      FaultCase{ReplyLayout::damiao, 0x9, DriveFault::under_voltage},
                      FaultCase{ReplyLayout::damiao, 0xA, DriveFault::over_current},
                      FaultCase{ReplyLayout::damiao, 0xB, DriveFault::over_temperature},
                      FaultCase{ReplyLayout::damiao, 0xC, DriveFault::rotor_over_temperature},
                      FaultCase{ReplyLayout::damiao, 0xD, DriveFault::communication_lost},
                      FaultCase{ReplyLayout::damiao, 0xE, DriveFault::overload}));

TEST(MotorReply, WrongLengthIsRefusedAndLeavesTheReplyAlone) {
  const std::pair<ReplyLayout, int> sizes[] = {{ReplyLayout::mini_cheetah, 6},
                                               {ReplyLayout::mini_cheetah_supply, 7},
                                               {ReplyLayout::ak, 8},
                                               {ReplyLayout::damiao, 8}};
  for (const auto& [layout, right] : sizes) {
    for (int size = 0; size <= 255; ++size) {
      CanFrame frame;
      frame.size = static_cast<std::uint8_t>(size);
      DriveReply reply;
      reply.drive_id = 77;
      const DecodeStatus status = decode_reply(family_of(layout), frame, reply);
      EXPECT_EQ(status, size == right ? DecodeStatus::ok : DecodeStatus::wrong_size);
      EXPECT_EQ(reply.drive_id, size == right ? 0 : 77);
    }
  }
}

TEST(MotorReply, ExtendedIdentifierIsRefused) {
  CanFrame frame = frame_of({1, 0x80, 0, 0x80, 0x08, 0, 30, 30});
  frame.id = 0x800;
  DriveReply reply;
  EXPECT_EQ(decode_reply(kFamily, frame, reply), DecodeStatus::bad_identifier);
}

TEST(DriveFault, NamesAreDistinct) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(DriveFault::unknown); ++i) {
    EXPECT_TRUE(names.insert(drive_fault_name(static_cast<DriveFault>(i))).second) << i;
  }
}

}  // namespace
}  // namespace hopscotch::hardware
