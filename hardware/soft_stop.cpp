#include "hardware/soft_stop.hpp"

#include <cmath>

namespace hopscotch::hardware {

using core::Range;

SoftStopConfig SoftStopConfig::load(const core::ConfigReader& section) {
  SoftStopConfig config;
  config.damping = section.number("damping_Nms_per_rad", Range::positive());
  config.still_speed = section.number("still_speed_radps", Range::positive());
  config.still_time = section.number("still_time_s", Range::not_negative());
  config.damping_time_max = section.number("damping_time_max_s", Range::above(0.0, 60.0));
  config.landing_kp = section.number("landing_kp_Nm_per_rad", Range::positive());
  config.landing_kd = section.number("landing_kd_Nms_per_rad", Range::positive());
  config.contact_torque = section.number("contact_torque_Nm", Range::positive());
  config.flight_time_max = section.number("flight_time_max_s", Range::above(0.0, 2.0));
  section.finish();
  return config;
}

void SoftStop::begin_in_flight(core::Stamp now, const core::JointVector& posture) noexcept {
  if (stage_ != Stage::not_started) return;
  stage_ = Stage::landing_posture;
  begun_ = now;
  posture_ = posture;
  loaded_ = 0;
}

void SoftStop::begin_on_ground(core::Stamp now) noexcept {
  if (stage_ != Stage::not_started) return;
  stage_ = Stage::damping;
  damped_ = now;
  moving_ = now;
}

void SoftStop::advance(core::Stamp now, const core::SensorReadings& readings) noexcept {
  constexpr int kSure = 3;          // readings; one alone may be noise
  constexpr double kSettle = 0.03;  // the posture's own jolt loads the knees for so long [s]
  if (stage_ == Stage::landing_posture) {
    const int knee = core::joint_index(core::Leg::left, core::Joint::knee);
    const int other = core::joint_index(core::Leg::right, core::Joint::knee);
    const double load = std::max(std::abs(readings.tau(knee)), std::abs(readings.tau(other)));
    loaded_ = load > config_.contact_torque ? loaded_ + 1 : 0;
    const bool met = loaded_ >= kSure && now.since(begun_) > kSettle;
    if (!met && now.since(begun_) < config_.flight_time_max) return;
    stage_ = Stage::damping;
    damped_ = now;
    moving_ = now;
  }
  if (stage_ == Stage::damping) {
    const bool still =
        readings.dq.allFinite() && readings.dq.cwiseAbs().maxCoeff() < config_.still_speed;
    if (!still) moving_ = now;
    const bool at_rest = still && now.since(moving_) >= config_.still_time;
    if (at_rest || now.since(damped_) >= config_.damping_time_max) stage_ = Stage::limp;
  }
}

core::JointCommand SoftStop::command(core::Stamp now,
                                     const core::SensorReadings& readings) noexcept {
  advance(now, readings);
  core::JointCommand command;
  command.stamp = now;
  switch (stage_) {
    case Stage::not_started:
    case Stage::limp: break;  // idle
    case Stage::landing_posture:
      command.mode = core::DriveMode::active;
      command.q = posture_;
      command.kp.setConstant(config_.landing_kp);
      command.kd.setConstant(config_.landing_kd);
      break;
    case Stage::damping:
      command.mode = core::DriveMode::damp;
      command.kd.setConstant(config_.damping);
      break;
  }
  return command;
}

}  // namespace hopscotch::hardware
