#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "apps/robot_config.hpp"
#include "control/control_config.hpp"
#include "core/control_status.hpp"
#include "core/operator_command.hpp"
#include "hardware/robot_plant.hpp"
#include "hardware/soft_stop.hpp"

namespace hopscotch::apps {

/// The controller as the session sees it.
struct SessionBrain {
  /// Readings to set-points, every exchange while the robot is active.
  std::function<core::JointCommand(const core::SensorReadings&)> tick;
  /// Of the last tick.
  std::function<core::ControlStatus()> status;
};

enum class SessionStage : std::uint8_t {
  off,       ///< No torque; joints are read.
  enabling,  ///< Drives are being turned on.
  ramping,   ///< Gains rise about the pose as it was found.
  active,    ///< The controller has the joints.
  stopping,  ///< Soft stop; ends in `off`.
};
[[nodiscard]] std::string_view session_stage_name(SessionStage stage);

/// Why the robot was last brought to rest.
struct SessionFault {
  core::Reason reason = core::Reason::none;
  hardware::PlantFault plant;                        ///< Where it came from there.
  core::RobotPhase phase = core::RobotPhase::stand;  ///< In which it happened.
};

/// Exchanges that came late.
struct DeadlineCounters {
  std::uint64_t late = 0;  ///< By more than half a period.
  double worst = 0.0;      ///< [s]
};

/// What speaks against enabling, in words; empty: nothing.
/// @param fault The latched one. @param q Measured [rad].
[[nodiscard]] std::string enabling_obstacle(const RobotConfig& config, SessionStage stage,
                                            core::Reason fault, const core::JointVector& q);

/// What stands between operator, controller and plant: drives go on only on the operator's word and
/// in the home pose, gains are ramped, and whatever goes wrong ends in a soft stop that knows
/// whether the robot is in the air. A fault stays until the operator clears it. Time comes from the
/// plant's stamps. `tick` is real-time safe if the brain is.
class RobotSession {
 public:
  /// @param plant           Outlives this object.
  /// @param landing_posture For a stop in flight [rad].
  RobotSession(const RobotConfig& config, hardware::RobotPlant& plant,
               const core::JointVector& landing_posture);

  /// One exchange with the plant and the next command.
  void tick();

  /// What speaks against enabling now, in words; empty: nothing.
  [[nodiscard]] std::string obstacle() const {
    return enabling_obstacle(config_, stage_, fault_.reason, readings_.q);
  }
  /// Turns the drives on for this brain, which is called for the first time when the pose is held.
  /// @pre obstacle().empty()
  void enable(SessionBrain brain);
  /// Brings the robot to rest now, as the operator wishes.
  void stop_now() noexcept { stop(core::Reason::stopped_by_user, {}); }
  /// @return false while the robot is not off.
  [[nodiscard]] bool clear_fault() noexcept;

  [[nodiscard]] SessionStage stage() const { return stage_; }
  [[nodiscard]] const SessionFault& fault() const { return fault_; }
  [[nodiscard]] const DeadlineCounters& deadlines() const { return deadlines_; }
  [[nodiscard]] const core::SensorReadings& readings() const { return readings_; }
  [[nodiscard]] const core::JointCommand& command() const { return command_; }

 private:
  void watch_deadline(core::Stamp before) noexcept;
  void advance_enabling();
  [[nodiscard]] core::JointCommand ramped_hold() const;
  [[nodiscard]] core::JointCommand controlled();
  void stop(core::Reason reason, const hardware::PlantFault& plant) noexcept;

  RobotConfig config_;
  hardware::RobotPlant& plant_;
  hardware::SoftStop soft_stop_;
  core::JointVector landing_posture_;
  SessionBrain brain_;
  SessionStage stage_ = SessionStage::off;
  SessionFault fault_;
  core::RobotPhase phase_ = core::RobotPhase::stand;
  core::SensorReadings readings_;
  core::JointCommand command_;
  core::Stamp stage_since_;
  core::JointVector held_ = core::JointVector::Zero();  // pose during the ramp [rad]
  DeadlineCounters deadlines_;
  std::array<core::Stamp, 3> last_late_{};  // ring of the last late exchanges
  std::size_t late_at_ = 0;
  bool timed_ = false;  // a stamp has been seen
};

}  // namespace hopscotch::apps
