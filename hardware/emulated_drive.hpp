#pragma once

#include <cstdint>
#include <optional>

#include "core/time.hpp"
#include "hardware/bus_topology.hpp"
#include "hardware/motor_protocol.hpp"

namespace hopscotch::hardware {

/// The output shaft of a drive, as its encoder and current sensor know it.
struct ShaftState {
  double position = 0.0;  ///< [rad]
  double speed = 0.0;     ///< [rad/s]
  double torque = 0.0;    ///< Given at present [N·m].
};

/// What can be wrong with one drive. Each changes what comes over the wire, nothing else.
struct DriveDefects {
  bool silent = false;                  ///< Hears and obeys nothing, answers nothing: no supply.
  bool deaf_for_reply = false;          ///< Obeys, but its answers are lost.
  bool encoder_stuck = false;           ///< Position and speed stay what they were.
  DriveFault fault = DriveFault::none;  ///< Trips the drive once; latched until cleared.
  double temperature_degC = 35.0;
  std::optional<std::uint32_t> reply_id;  ///< Answers with another identifier.
  std::optional<double> torque_max;       ///< Its torque range is set to this [N·m].
};

/// The firmware of one drive: hears frames, answers each, closes its PD at its own encoder, and
/// goes limp when commands stay away. After the mini-cheetah reference firmware and the manuals of
/// its relatives: special commands do not feed the watchdog, an answer is packed before the command
/// is applied; a Damiao drive latches the loss of communication, the others go on with the next
/// command.
class EmulatedDrive {
 public:
  /// @param watchdog Without a set-point for longer than this the drive goes limp [s].
  EmulatedDrive(const DriveMount& mount, double watchdog);

  /// A frame of the bus. @return The answer, if the frame was for this drive and it can speak.
  std::optional<CanFrame> receive(const CanFrame& frame, const ShaftState& shaft, core::Stamp now);

  /// Torque that its law demands now [N·m]; zero outside motor mode. Not limited by the motor.
  [[nodiscard]] double torque(const ShaftState& shaft, core::Stamp now);

  [[nodiscard]] bool in_motor_mode() const { return in_motor_mode_; }
  /// The set-points in force; zero outside motor mode.
  [[nodiscard]] const DriveSetpoint& setpoint() const { return setpoint_; }
  [[nodiscard]] DriveDefects& defects() { return defects_; }

 private:
  [[nodiscard]] DriveFamily family() const;
  [[nodiscard]] ShaftState measured(const ShaftState& shaft);
  [[nodiscard]] CanFrame answer(const ShaftState& measured) const;
  [[nodiscard]] std::optional<CanFrame> register_answer(const CanFrame& frame) const;
  void obey(SpecialCommand command);
  void watch(core::Stamp now);
  void trip(DriveFault fault);

  DriveMount mount_;
  double watchdog_;
  DriveDefects defects_;
  DriveSetpoint setpoint_;
  DriveFault latched_ = DriveFault::none;
  bool in_motor_mode_ = false;
  std::optional<core::Stamp> commanded_;  // last set-point
  std::optional<ShaftState> stuck_at_;
};

}  // namespace hopscotch::hardware
