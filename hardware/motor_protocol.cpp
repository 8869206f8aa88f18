#include "hardware/motor_protocol.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace hopscotch::hardware {
namespace {

constexpr std::uint32_t kPositionCodeMax = 0xFFFF;  // 16 bits
constexpr std::uint32_t kCodeMax = 0xFFF;           // 12 bits: speed, gains, torque
constexpr std::uint32_t kIdentifierMax = 0x7FF;     // standard frame
constexpr std::uint8_t kAllOnes = 0xFF;
constexpr std::uint8_t kReadRegister = 0x33;

/// kd fills byte 5 and half of byte 6. While it stays below full scale those are never all ones, so
/// no set-point can look like a special command.
constexpr std::uint32_t kDampingCodeMax = kCodeMax - 1;

/// A number on the wire: `codes` + 1 equidistant values from `lowest` to `highest`.
struct Scale {
  double lowest;
  double highest;
  std::uint32_t codes;

  [[nodiscard]] double step() const { return (highest - lowest) / codes; }
  [[nodiscard]] double value(std::uint32_t code) const { return lowest + code * step(); }
  [[nodiscard]] std::uint32_t code(double value) const {
    // Multiplied before divided, so that values half-way between two codes are so exactly and go
    // up.
    const double position =
        (std::clamp(value, lowest, highest) - lowest) * codes / (highest - lowest);
    return std::min(static_cast<std::uint32_t>(std::lround(position)), codes);
  }
  [[nodiscard]] bool contains(double value) const { return value >= lowest && value <= highest; }
};

struct Scales {
  Scale position;
  Scale speed;
  Scale kp;
  Scale kd;
  Scale torque;
};

Scales scales_of(const DriveFamily& family) {
  return {.position = {-family.position_max, family.position_max, kPositionCodeMax},
          .speed = {-family.speed_max, family.speed_max, kCodeMax},
          .kp = {0.0, family.kp_max, kCodeMax},
          .kd = {0.0, family.kd_max, kCodeMax},
          .torque = {-family.torque_max, family.torque_max, kCodeMax}};
}

bool is_finite(const DriveSetpoint& setpoint) {
  return std::isfinite(setpoint.position) && std::isfinite(setpoint.speed) &&
         std::isfinite(setpoint.kp) && std::isfinite(setpoint.kd) && std::isfinite(setpoint.torque);
}

bool fits(const Scales& scales, const DriveSetpoint& setpoint) {
  return scales.position.contains(setpoint.position) && scales.speed.contains(setpoint.speed) &&
         scales.kp.contains(setpoint.kp) && scales.kd.contains(setpoint.kd) &&
         scales.torque.contains(setpoint.torque);
}

std::uint8_t byte(std::uint32_t bits) {
  return static_cast<std::uint8_t>(bits & 0xFFU);
}

DriveFault ak_fault(std::uint8_t code) {
  switch (code) {
    case 0: return DriveFault::none;
    case 1: return DriveFault::over_temperature;
    case 2: return DriveFault::over_current;
    case 3: return DriveFault::over_voltage;
    case 4: return DriveFault::under_voltage;
    case 5: return DriveFault::encoder;
    case 6: return DriveFault::phase_unbalance;
    default: return DriveFault::unknown;
  }
}

DriveFault damiao_fault(std::uint8_t status) {
  switch (status) {
    case 0x0:  // disabled
    case 0x1: return DriveFault::none;
    case 0x8: return DriveFault::over_voltage;
    case 0x9: return DriveFault::under_voltage;
    case 0xA: return DriveFault::over_current;
    case 0xB: return DriveFault::over_temperature;
    case 0xC: return DriveFault::rotor_over_temperature;
    case 0xD: return DriveFault::communication_lost;
    case 0xE: return DriveFault::overload;
    default: return DriveFault::unknown;
  }
}

/// A fault as the family's code; families without such a code have no way to say it.
std::uint8_t ak_code(DriveFault fault) {
  for (std::uint8_t code = 0; code <= 6; ++code) {
    if (ak_fault(code) == fault) return code;
  }
  return 7;  // any code that the family does not define
}

std::uint8_t damiao_status(const DriveReply& reply) {
  if (reply.fault == DriveFault::none) return reply.enabled.value_or(false) ? 0x1 : 0x0;
  for (std::uint8_t status = 0x8; status <= 0xE; ++status) {
    if (damiao_fault(status) == reply.fault) return status;
  }
  return 0xF;
}

std::uint8_t whole_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

void decode_extras(const DriveFamily& family, const CanFrame& frame, DriveReply& reply) {
  const auto& data = frame.data;
  switch (family.reply) {
    case ReplyLayout::mini_cheetah: break;
    case ReplyLayout::mini_cheetah_supply:
      reply.supply = Scale{0.0, family.supply_max, kAllOnes}.value(data[6]);
      break;
    case ReplyLayout::ak:
      reply.temperature_degC = data[6] + family.temperature_offset_degC;
      reply.fault = ak_fault(data[7]);
      break;
    case ReplyLayout::damiao: {
      const auto status = static_cast<std::uint8_t>(data[0] >> 4U);
      reply.drive_id = data[0] & 0x0FU;
      reply.enabled = status == 0x1;
      reply.fault = damiao_fault(status);
      reply.temperature_degC = data[6];
      reply.rotor_temperature_degC = data[7];
      break;
    }
  }
}

}  // namespace

std::string_view drive_fault_name(DriveFault fault) {
  switch (fault) {
    case DriveFault::none: return "none";
    case DriveFault::over_temperature: return "over-temperature";
    case DriveFault::rotor_over_temperature: return "rotor over-temperature";
    case DriveFault::over_current: return "over-current";
    case DriveFault::over_voltage: return "over-voltage";
    case DriveFault::under_voltage: return "under-voltage";
    case DriveFault::encoder: return "encoder";
    case DriveFault::phase_unbalance: return "phase unbalance";
    case DriveFault::communication_lost: return "communication lost";
    case DriveFault::overload: return "overload";
    case DriveFault::unknown: return "unknown fault code";
  }
  return "unknown fault code";
}

EncodeStatus encode_setpoint(const DriveFamily& family, std::uint8_t drive_id,
                             const DriveSetpoint& setpoint, CanFrame& frame) noexcept {
  if (!is_finite(setpoint)) return EncodeStatus::not_finite;
  const Scales scales = scales_of(family);
  const std::uint32_t p = scales.position.code(setpoint.position);
  const std::uint32_t v = scales.speed.code(setpoint.speed);
  const std::uint32_t kp = scales.kp.code(setpoint.kp);
  const std::uint32_t kd = std::min(scales.kd.code(setpoint.kd), kDampingCodeMax);
  const std::uint32_t t = scales.torque.code(setpoint.torque);
  frame.id = drive_id;
  frame.size = 8;
  frame.data = {byte(p >> 8U),
                byte(p),
                byte(v >> 4U),
                byte(v << 4U | kp >> 8U),
                byte(kp),
                byte(kd >> 4U),
                byte(kd << 4U | t >> 8U),
                byte(t)};
  return fits(scales, setpoint) ? EncodeStatus::exact : EncodeStatus::clamped;
}

std::optional<CanFrame> encode_special(const DriveFamily& family, std::uint8_t drive_id,
                                       SpecialCommand command) noexcept {
  if (command == SpecialCommand::clear_error && family.reply != ReplyLayout::damiao) {
    return std::nullopt;
  }
  CanFrame frame{.id = drive_id, .size = 8};
  frame.data.fill(kAllOnes);
  frame.data[7] = static_cast<std::uint8_t>(command);
  return frame;
}

std::optional<SpecialCommand> special_command(const CanFrame& frame) noexcept {
  const bool marked = frame.size == 8 && std::all_of(frame.data.begin(), frame.data.begin() + 7,
                                                     [](std::uint8_t b) { return b == kAllOnes; });
  const auto first = static_cast<std::uint8_t>(SpecialCommand::clear_error);
  const auto last = static_cast<std::uint8_t>(SpecialCommand::set_zero);
  if (!marked || frame.data[7] < first || frame.data[7] > last) return std::nullopt;
  return static_cast<SpecialCommand>(frame.data[7]);
}

std::optional<DriveSetpoint> decode_setpoint(const DriveFamily& family,
                                             const CanFrame& frame) noexcept {
  if (frame.size != 8 || special_command(frame)) return std::nullopt;
  const Scales scales = scales_of(family);
  std::array<std::uint32_t, CanFrame::kMaxSize> b{};
  std::copy(frame.data.begin(), frame.data.end(), b.begin());
  return DriveSetpoint{.position = scales.position.value(b[0] << 8U | b[1]),
                       .speed = scales.speed.value(b[2] << 4U | b[3] >> 4U),
                       .kp = scales.kp.value((b[3] & 0xFU) << 8U | b[4]),
                       .kd = scales.kd.value(b[5] << 4U | b[6] >> 4U),
                       .torque = scales.torque.value((b[6] & 0xFU) << 8U | b[7])};
}

std::size_t reply_size(ReplyLayout layout) noexcept {
  switch (layout) {
    case ReplyLayout::mini_cheetah: return 6;
    case ReplyLayout::mini_cheetah_supply: return 7;
    case ReplyLayout::ak:
    case ReplyLayout::damiao: return 8;
  }
  return 0;
}

DecodeStatus decode_reply(const DriveFamily& family, const CanFrame& frame,
                          DriveReply& reply) noexcept {
  if (frame.id > kIdentifierMax) return DecodeStatus::bad_identifier;
  if (frame.size != reply_size(family.reply)) return DecodeStatus::wrong_size;
  const Scales scales = scales_of(family);
  std::array<std::uint32_t, CanFrame::kMaxSize> b{};
  std::copy(frame.data.begin(), frame.data.end(), b.begin());
  reply = DriveReply{};
  reply.drive_id = frame.data[0];
  reply.position = scales.position.value(b[1] << 8U | b[2]);
  reply.speed = scales.speed.value(b[3] << 4U | b[4] >> 4U);
  reply.torque = scales.torque.value((b[4] & 0xFU) << 8U | b[5]);
  decode_extras(family, frame, reply);
  return DecodeStatus::ok;
}

CanFrame encode_reply(const DriveFamily& family, std::uint32_t reply_id,
                      const DriveReply& reply) noexcept {
  const Scales scales = scales_of(family);
  const std::uint32_t p = scales.position.code(reply.position);
  const std::uint32_t v = scales.speed.code(reply.speed);
  const std::uint32_t t = scales.torque.code(reply.torque);
  CanFrame frame{.id = reply_id, .size = static_cast<std::uint8_t>(reply_size(family.reply))};
  frame.data = {reply.drive_id, byte(p >> 8U),           byte(p),
                byte(v >> 4U),  byte(v << 4U | t >> 8U), byte(t)};
  switch (family.reply) {
    case ReplyLayout::mini_cheetah: break;
    case ReplyLayout::mini_cheetah_supply:
      frame.data[6] = byte(Scale{0.0, family.supply_max, kAllOnes}.code(reply.supply));
      break;
    case ReplyLayout::ak:
      frame.data[6] = whole_byte(reply.temperature_degC - family.temperature_offset_degC);
      frame.data[7] = ak_code(reply.fault);
      break;
    case ReplyLayout::damiao:
      frame.data[0] =
          byte(static_cast<std::uint32_t>(damiao_status(reply)) << 4U | (reply.drive_id & 0x0FU));
      frame.data[6] = whole_byte(reply.temperature_degC);
      frame.data[7] = whole_byte(reply.rotor_temperature_degC);
      break;
  }
  return frame;
}

CanFrame encode_register_request(std::uint8_t drive_id, DriveRegister which) noexcept {
  CanFrame frame{.id = kRegisterIdentifier, .size = 8};
  frame.data = {drive_id, 0, kReadRegister, static_cast<std::uint8_t>(which)};
  return frame;
}

CanFrame encode_register_answer(std::uint32_t reply_id, const RegisterMessage& message) noexcept {
  CanFrame frame = encode_register_request(message.drive_id, message.which);
  frame.id = reply_id;
  // Little-endian float, unlike everything else on this bus.
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(message.value));
  for (std::size_t i = 0; i < 4; ++i) frame.data[4 + i] = byte(bits >> (8 * i));
  return frame;
}

std::optional<RegisterMessage> decode_register(const CanFrame& frame) noexcept {
  if (frame.size != 8 || frame.data[1] != 0 || frame.data[2] != kReadRegister) return std::nullopt;
  const auto first = static_cast<std::uint8_t>(DriveRegister::position_max);
  const auto last = static_cast<std::uint8_t>(DriveRegister::torque_max);
  if (frame.data[3] < first || frame.data[3] > last) return std::nullopt;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    bits |= static_cast<std::uint32_t>(frame.data[4 + i]) << (8 * i);
  }
  return RegisterMessage{.drive_id = frame.data[0],
                         .which = static_cast<DriveRegister>(frame.data[3]),
                         .value = static_cast<double>(std::bit_cast<float>(bits))};
}

}  // namespace hopscotch::hardware
