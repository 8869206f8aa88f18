#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/robot_state.hpp"
#include "hardware/can_frame.hpp"
#include "hardware/drive_family.hpp"

/// The MIT-mode frames of mini-cheetah, AK and Damiao drives: pure functions between values and
/// bytes. Everything here is real-time safe: no allocation, lock or exception.
namespace hopscotch::hardware {

/// What one drive is to do until the next frame: it applies
/// torque + kp (position - measured) + kd (speed - measured), all at its output shaft.
struct DriveSetpoint {
  double position = 0.0;  ///< [rad]
  double speed = 0.0;     ///< [rad/s]
  double kp = 0.0;        ///< [N·m/rad]
  double kd = 0.0;        ///< [N·m·s/rad]
  double torque = 0.0;    ///< Feed-forward [N·m].
};

/// Frames that mean something else than a set-point. The value is the frame's last byte; the seven
/// before it are 0xFF.
enum class SpecialCommand : std::uint8_t {
  clear_error = 0xFB,  ///< Damiao only.
  enter_motor_mode = 0xFC,
  exit_motor_mode = 0xFD,
  set_zero = 0xFE,  ///< Writes the drive's flash.
};

/// What a drive says is wrong with it.
enum class DriveFault : std::uint8_t {
  none,
  over_temperature,
  rotor_over_temperature,
  over_current,
  over_voltage,
  under_voltage,
  encoder,
  phase_unbalance,
  communication_lost,
  overload,
  unknown,  ///< A code that the family does not define.
};
[[nodiscard]] std::string_view drive_fault_name(DriveFault fault);

/// A drive's answer. What the family does not report is NaN or empty.
struct DriveReply {
  std::uint8_t drive_id = 0;
  double position = core::kNaN;                ///< [rad]
  double speed = core::kNaN;                   ///< [rad/s]
  double torque = core::kNaN;                  ///< From the motor current [N·m].
  double supply = core::kNaN;                  ///< [V]
  double temperature_degC = core::kNaN;        ///< Of the transistors.
  double rotor_temperature_degC = core::kNaN;  ///< Of the winding.
  std::optional<bool> enabled;                 ///< In motor mode.
  DriveFault fault = DriveFault::none;
};

enum class EncodeStatus : std::uint8_t {
  exact,       ///< Every number fits its range; the wire rounds it to the nearest code.
  clamped,     ///< At least one number was outside its range and was put on the bound.
  not_finite,  ///< NaN or infinity; no frame was written.
};

/// Set-point to command frame with identifier `drive_id`. Rounds to the nearest code. The largest
/// codes never form a special command: the gain kd stops one code below full scale.
/// @param[out] frame Written unless the status is `not_finite`.
[[nodiscard]] EncodeStatus encode_setpoint(const DriveFamily& family, std::uint8_t drive_id,
                                           const DriveSetpoint& setpoint, CanFrame& frame) noexcept;

/// The command frame of a special command; nothing if the family does not know it.
[[nodiscard]] std::optional<CanFrame> encode_special(const DriveFamily& family,
                                                     std::uint8_t drive_id,
                                                     SpecialCommand command) noexcept;

/// Which special command a command frame is, if any.
[[nodiscard]] std::optional<SpecialCommand> special_command(const CanFrame& frame) noexcept;

/// What the drive will understand of a command frame; nothing if it is a special command or has
/// not 8 bytes. With `encode_setpoint` it tells what is left of a set-point after rounding.
[[nodiscard]] std::optional<DriveSetpoint> decode_setpoint(const DriveFamily& family,
                                                           const CanFrame& frame) noexcept;

enum class DecodeStatus : std::uint8_t {
  ok,
  wrong_size,      ///< The family's replies have another length.
  bad_identifier,  ///< Not an 11-bit identifier.
};

/// Answer frame to values. Which drive answered is in the data; the frame's identifier is the
/// host's and is not looked at beyond its range.
/// @param[out] reply Written only when the status is `ok`.
[[nodiscard]] DecodeStatus decode_reply(const DriveFamily& family, const CanFrame& frame,
                                        DriveReply& reply) noexcept;

/// Bytes of an answer.
[[nodiscard]] std::size_t reply_size(ReplyLayout layout) noexcept;

/// The inverse of `decode_reply`, for emulated drives: rounds to the nearest code, clamps to the
/// family's ranges. @param reply_id Identifier of the frame. @pre the numbers of the layout are
/// finite.
[[nodiscard]] CanFrame encode_reply(const DriveFamily& family, std::uint32_t reply_id,
                                    const DriveReply& reply) noexcept;

/// Settings of a Damiao drive that tell its ranges.
enum class DriveRegister : std::uint8_t {
  position_max = 0x15,
  speed_max = 0x16,
  torque_max = 0x17
};

/// What a register request or its answer says.
struct RegisterMessage {
  std::uint8_t drive_id = 0;
  DriveRegister which = DriveRegister::position_max;
  double value = 0.0;  ///< Answers only, SI units.
};
/// Register requests go to every Damiao drive with this identifier.
inline constexpr std::uint32_t kRegisterIdentifier = 0x7FF;

/// Asks a Damiao drive for a register; it answers with its reply identifier.
[[nodiscard]] CanFrame encode_register_request(std::uint8_t drive_id, DriveRegister which) noexcept;
[[nodiscard]] CanFrame encode_register_answer(std::uint32_t reply_id,
                                              const RegisterMessage& message) noexcept;
/// Nothing if the frame is neither a request (identifier 0x7FF) nor an answer for one of the three
/// registers. An ordinary answer can have the same first bytes by chance, so ask only while none is
/// under way.
[[nodiscard]] std::optional<RegisterMessage> decode_register(const CanFrame& frame) noexcept;

}  // namespace hopscotch::hardware
