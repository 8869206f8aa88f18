#include "hardware/emulated_drive.hpp"

namespace hopscotch::hardware {

EmulatedDrive::EmulatedDrive(const DriveMount& mount, double watchdog)
    : mount_(mount), watchdog_(watchdog) {}

DriveFamily EmulatedDrive::family() const {
  DriveFamily family = mount_.family;
  family.torque_max = defects_.torque_max.value_or(family.torque_max);
  return family;
}

ShaftState EmulatedDrive::measured(const ShaftState& shaft) {
  if (!defects_.encoder_stuck) {
    stuck_at_.reset();
    return shaft;
  }
  if (!stuck_at_) stuck_at_ = shaft;
  return {.position = stuck_at_->position, .speed = stuck_at_->speed, .torque = shaft.torque};
}

std::optional<CanFrame> EmulatedDrive::receive(const CanFrame& frame, const ShaftState& shaft,
                                               core::Stamp now) {
  if (defects_.silent) return std::nullopt;
  watch(now);
  if (frame.id == kRegisterIdentifier) return register_answer(frame);
  if (frame.id != mount_.id) return std::nullopt;
  const CanFrame reply = answer(measured(shaft));
  if (const std::optional<SpecialCommand> command = special_command(frame)) {
    obey(*command);
  } else if (const std::optional<DriveSetpoint> wanted = decode_setpoint(family(), frame)) {
    commanded_ = now;
    if (in_motor_mode_) setpoint_ = *wanted;
  }
  if (defects_.deaf_for_reply) return std::nullopt;
  return reply;
}

std::optional<CanFrame> EmulatedDrive::register_answer(const CanFrame& frame) const {
  const std::optional<RegisterMessage> request = decode_register(frame);
  if (mount_.family.reply != ReplyLayout::damiao || !request || request->drive_id != mount_.id) {
    return std::nullopt;
  }
  const DriveFamily ranges = family();
  RegisterMessage message = *request;
  switch (request->which) {
    case DriveRegister::position_max: message.value = ranges.position_max; break;
    case DriveRegister::speed_max: message.value = ranges.speed_max; break;
    case DriveRegister::torque_max: message.value = ranges.torque_max; break;
  }
  return encode_register_answer(mount_.reply_id, message);
}

void EmulatedDrive::obey(SpecialCommand command) {
  switch (command) {
    case SpecialCommand::clear_error:
      latched_ = DriveFault::none;
      defects_.fault = DriveFault::none;
      break;
    case SpecialCommand::enter_motor_mode:
      if (latched_ == DriveFault::none && !in_motor_mode_) {
        in_motor_mode_ = true;
        setpoint_ = {};
        commanded_.reset();  // the watchdog counts from the first set-point
      }
      break;
    case SpecialCommand::exit_motor_mode:
      in_motor_mode_ = false;
      setpoint_ = {};
      break;
    case SpecialCommand::set_zero: break;  // would write its flash; nothing here asks for it
  }
}

void EmulatedDrive::trip(DriveFault fault) {
  latched_ = fault;
  in_motor_mode_ = false;
  setpoint_ = {};
}

void EmulatedDrive::watch(core::Stamp now) {
  if (defects_.fault != DriveFault::none && latched_ == DriveFault::none) trip(defects_.fault);
  if (!in_motor_mode_ || !commanded_ || now.since(*commanded_) <= watchdog_) return;
  if (mount_.family.reply == ReplyLayout::damiao) {
    trip(DriveFault::communication_lost);
  } else {
    setpoint_ = {};
  }
}

double EmulatedDrive::torque(const ShaftState& shaft, core::Stamp now) {
  if (defects_.silent) in_motor_mode_ = false;
  watch(now);
  if (!in_motor_mode_) return 0.0;
  const ShaftState seen = measured(shaft);
  return setpoint_.torque + setpoint_.kp * (setpoint_.position - seen.position) +
         setpoint_.kd * (setpoint_.speed - seen.speed);
}

CanFrame EmulatedDrive::answer(const ShaftState& measured) const {
  DriveReply reply;
  reply.drive_id = mount_.id;
  reply.position = measured.position;
  reply.speed = measured.speed;
  reply.torque = measured.torque;
  constexpr double kSupply = 24.0;      // [V]
  constexpr double kRotorWarmer = 5.0;  // winding above transistors, at rest [K]
  reply.supply = kSupply;
  reply.temperature_degC = defects_.temperature_degC;
  reply.rotor_temperature_degC = defects_.temperature_degC + kRotorWarmer;
  reply.enabled = in_motor_mode_;
  reply.fault = latched_;
  return encode_reply(family(), defects_.reply_id.value_or(mount_.reply_id), reply);
}

}  // namespace hopscotch::hardware
