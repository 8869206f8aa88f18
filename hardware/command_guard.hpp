#pragma once

#include <cstdint>

#include "core/config_reader.hpp"
#include "core/joint_command.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::hardware {

/// What the guard lets pass besides the robot's own limits; section `hardware.command_guard`.
struct CommandGuardConfig {
  double kp_max = 0.0;         ///< [N·m/rad]
  double kd_max = 0.0;         ///< [N·m·s/rad]
  double overshoot_max = 0.0;  ///< A joint measured farther than this beyond its range: damp [rad].
  double damping = 0.0;        ///< kd of all joints when the guard damps [N·m·s/rad].

  /// @throws core::ConfigError naming the key, its value and the violated rule.
  static CommandGuardConfig load(const core::ConfigReader& section);
};

/// How often each rule had to act, in joints (`not_finite`: in commands).
struct GuardCounters {
  std::uint64_t not_finite = 0;  ///< Command or reading with NaN or infinity; damped.
  std::uint64_t overshoot = 0;   ///< Measured beyond the joint's range; damped.
  std::uint64_t position = 0;    ///< Set-point put on the end of the joint's range.
  std::uint64_t speed = 0;       ///< Set-point put on the motor's speed limit.
  std::uint64_t gain = 0;        ///< Gain negative or too large, put on its bound.
  std::uint64_t torque = 0;      ///< Feed-forward cut, so that the motor's demand keeps its limit.
};

enum class GuardVerdict : std::uint8_t {
  passed,   ///< Bit for bit what came in.
  limited,  ///< At least one number was changed.
  damped,   ///< Replaced as a whole by damping.
};

/// The last check between controller and wire: whatever the controller asks for, what comes out is
/// finite and within the limits of joints, motors and gains. Keeps count of what it had to do.
class CommandGuard {
 public:
  CommandGuard(const CommandGuardConfig& config, const model::RobotParameters& robot);

  /// @param q, dq   Newest readings [rad, rad/s]; the demand of the drive's PD is judged by them.
  /// @param[out] safe Always written.
  /// Real-time: no allocation, lock or exception.
  [[nodiscard]] GuardVerdict filter(const core::JointCommand& wanted, const core::JointVector& q,
                                    const core::JointVector& dq, core::JointCommand& safe) noexcept;

  [[nodiscard]] const GuardCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] bool must_damp(const core::JointCommand& wanted, const core::JointVector& q,
                               const core::JointVector& dq) noexcept;
  void limit_setpoints(core::JointCommand& command) noexcept;
  void limit_torque(core::JointCommand& command, const core::JointVector& q,
                    const core::JointVector& dq) noexcept;

  CommandGuardConfig config_;
  core::JointVector lower_;       ///< Joint ranges [rad].
  core::JointVector upper_;       ///< Joint ranges [rad].
  core::JointVector speed_max_;   ///< Of the set-point [rad/s].
  core::JointVector torque_max_;  ///< Per motor, at the joint side of its reduction [N·m].
  GuardCounters counters_;
};

}  // namespace hopscotch::hardware
