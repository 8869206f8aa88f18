#pragma once

#include <cstdint>
#include <optional>

#include "core/config_reader.hpp"
#include "core/joint_command.hpp"
#include "core/sensor_readings.hpp"

namespace hopscotch::hardware {

/// How the robot comes to rest when its controller is no longer to be trusted; section `soft_stop`.
struct SoftStopConfig {
  double damping = 0.0;           ///< kd of all joints [N·m·s/rad].
  double still_speed = 0.0;       ///< All joints slower than this: drives off [rad/s].
  double still_time = 0.0;        ///< For so long [s].
  double damping_time_max = 0.0;  ///< Then the drives go off, still or not [s].
  double landing_kp = 0.0;        ///< Of the landing posture in the air [N·m/rad].
  double landing_kd = 0.0;        ///< [N·m·s/rad]
  double contact_torque = 0.0;    ///< A knee that bears more than this has met the ground [N·m].
  double flight_time_max = 0.0;   ///< No fall takes longer [s].

  static SoftStopConfig load(const core::ConfigReader& section);
};

/// The end of all motion, by joint sensors alone: on the ground damping until the joints are
/// still, then no torque. In the air the legs first take the landing posture with moderate gains,
/// as limp legs would land on the knees; damping follows when a knee feels the ground or when no
/// fall takes so long. Readings that are stale are not trusted for contact. Real-time safe.
class SoftStop {
 public:
  explicit SoftStop(const SoftStopConfig& config) : config_(config) {}

  enum class Stage : std::uint8_t { not_started, landing_posture, damping, limp };

  /// @param posture Joint angles to land with [rad].
  void begin_in_flight(core::Stamp now, const core::JointVector& posture) noexcept;
  void begin_on_ground(core::Stamp now) noexcept;
  /// As if nothing had been.
  void reset() noexcept { stage_ = Stage::not_started; }

  /// @param now May be later than the readings' stamp. @pre begun.
  [[nodiscard]] core::JointCommand command(core::Stamp now,
                                           const core::SensorReadings& readings) noexcept;

  [[nodiscard]] Stage stage() const { return stage_; }

 private:
  void advance(core::Stamp now, const core::SensorReadings& readings) noexcept;

  SoftStopConfig config_;
  Stage stage_ = Stage::not_started;
  core::Stamp begun_;
  core::Stamp damped_;  // since
  core::Stamp moving_;
  int loaded_ = 0;  // readings in a row with a loaded knee
  core::JointVector posture_ = core::JointVector::Zero();
};

}  // namespace hopscotch::hardware
