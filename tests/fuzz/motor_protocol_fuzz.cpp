// Any bytes from the bus: decoding never fails otherwise than by its status, what it decodes lies
// in the drive's ranges, and what is encoded again says the same. Input: layout, identifier (2
// bytes), size, up to 8 data bytes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/check.hpp"
#include "hardware/motor_protocol.hpp"

namespace {

using namespace hopscotch::hardware;

DriveFamily family_of(std::uint8_t choice) {
  DriveFamily family;
  family.reply = static_cast<ReplyLayout>(choice % 4);
  family.position_max = 12.5;
  family.speed_max = 45.0;
  family.torque_max = 54.0;
  family.kp_max = 500.0;
  family.kd_max = 5.0;
  family.supply_max = 40.0;
  return family;
}

bool within(double value, double bound) {
  constexpr double kRounding = 1e-9;
  return std::abs(value) <= bound + kRounding;
}

void check_reply(const DriveFamily& family, const CanFrame& frame) {
  DriveReply reply;
  if (decode_reply(family, frame, reply) != DecodeStatus::ok) return;
  HOPSCOTCH_CHECK(within(reply.position, family.position_max));
  HOPSCOTCH_CHECK(within(reply.speed, family.speed_max));
  HOPSCOTCH_CHECK(within(reply.torque, family.torque_max));
  HOPSCOTCH_CHECK(!drive_fault_name(reply.fault).empty());
}

void check_setpoint(const DriveFamily& family, const CanFrame& frame) {
  const auto setpoint = decode_setpoint(family, frame);
  if (!setpoint) return;
  CanFrame again;
  const EncodeStatus status =
      encode_setpoint(family, static_cast<std::uint8_t>(frame.id), *setpoint, again);
  HOPSCOTCH_CHECK(status != EncodeStatus::not_finite);
  HOPSCOTCH_CHECK(!special_command(again).has_value());
  // Only the top code of kd may not come back: see encode_setpoint.
  const bool kd_full = frame.data[5] == 0xFF && frame.data[6] >> 4U == 0xF;
  HOPSCOTCH_CHECK(kd_full || again.data == frame.data);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4) return 0;
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(data[1]) << 8U | data[2];
  frame.size = data[3];
  std::copy_n(data + 4, std::min<std::size_t>(size - 4, CanFrame::kMaxSize), frame.data.begin());
  const DriveFamily family = family_of(data[0]);
  check_reply(family, frame);
  check_setpoint(family, frame);
  return 0;
}
