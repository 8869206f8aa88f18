#include "apps/robot_session.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace hopscotch::apps {

using core::DriveMode;
using core::Reason;

namespace {

// One exchange as late as this, or more than three late ones within the window, is a fault.
constexpr double kLateMax = 0.005;   // [s]
constexpr double kLateWindow = 0.1;  // [s]
constexpr double kLateFrom = 0.5;    // of a period

}  // namespace

std::string_view session_stage_name(SessionStage stage) {
  switch (stage) {
    case SessionStage::off: return "off";
    case SessionStage::enabling: return "enabling";
    case SessionStage::ramping: return "ramping";
    case SessionStage::active: return "active";
    case SessionStage::stopping: return "stopping";
  }
  return "off";
}

std::string enabling_obstacle(const RobotConfig& config, SessionStage stage, Reason fault,
                              const core::JointVector& q) {
  if (stage != SessionStage::off) {
    return "the robot is " + std::string(session_stage_name(stage)) + ", not off";
  }
  if (fault != Reason::none && fault != Reason::stopped_by_user) {
    return "fault " + std::string(core::reason_code(fault)) + " is latched: clear it first";
  }
  return hardware::homing_problem(config.homing, config.robot, q);
}

RobotSession::RobotSession(const RobotConfig& config, hardware::RobotPlant& plant,
                           const core::JointVector& landing_posture)
    : config_(config),
      plant_(plant),
      soft_stop_(config.soft_stop),
      landing_posture_(landing_posture) {}

void RobotSession::tick() {
  const core::Stamp before = readings_.stamp;
  readings_ = plant_.exchange(command_);
  if (timed_) watch_deadline(before);
  timed_ = true;
  const hardware::PlantFault& fault = plant_.fault();
  if (fault.reason != Reason::none) stop(fault.reason, fault);
  switch (stage_) {
    case SessionStage::off: command_ = {}; break;
    case SessionStage::enabling:
      command_ = {};
      advance_enabling();
      break;
    case SessionStage::ramping:
      command_ = ramped_hold();
      if (readings_.stamp.since(stage_since_) >= config_.session.ramp + config_.session.settle) {
        stage_ = SessionStage::active;
      }
      break;
    case SessionStage::active: command_ = controlled(); break;
    case SessionStage::stopping: break;
  }
  if (stage_ != SessionStage::stopping) return;
  command_ = soft_stop_.command(readings_.stamp, readings_);
  if (soft_stop_.stage() == hardware::SoftStop::Stage::limp) {
    plant_.set_power(hardware::DrivePower::off);
    stage_ = SessionStage::off;
  }
}

void RobotSession::watch_deadline(core::Stamp before) noexcept {
  const double period = 1.0 / config_.topology.rate;
  const double late = readings_.stamp.since(before) - period;
  if (late <= kLateFrom * period) return;
  ++deadlines_.late;
  deadlines_.worst = std::max(deadlines_.worst, late);
  const bool often = deadlines_.late > last_late_.size() &&
                     readings_.stamp.since(last_late_[late_at_]) <= kLateWindow;
  last_late_[late_at_] = readings_.stamp;
  late_at_ = (late_at_ + 1) % last_late_.size();
  if (late >= kLateMax || often) stop(Reason::deadline, {});
}

void RobotSession::advance_enabling() {
  if (plant_.powered()) {
    stage_ = SessionStage::ramping;
    stage_since_ = readings_.stamp;
    held_ = readings_.q;
  } else if (readings_.stamp.since(stage_since_) > config_.session.enable_timeout) {
    stop(Reason::drive_silent, {});
  }
}

core::JointCommand RobotSession::ramped_hold() const {
  const double share =
      std::clamp(readings_.stamp.since(stage_since_) / config_.session.ramp, 0.0, 1.0);
  const control::JointGains& gains = config_.tuning.control.gains;
  core::JointCommand command;
  command.stamp = readings_.stamp;
  command.mode = DriveMode::active;
  command.q = held_;
  command.kp << share * gains.kp, share * gains.kp;
  command.kd << share * gains.kd, share * gains.kd;
  return command;
}

core::JointCommand RobotSession::controlled() {
  core::JointCommand command = brain_.tick(readings_);
  const core::ControlStatus status = brain_.status();
  if (status.fault != Reason::none) {
    stop(status.fault, {});
  } else if (core::is_limp(status.phase)) {
    stop(Reason::stopped_by_user, {});
  } else {
    phase_ = status.phase;
  }
  plant_.notify_phase(phase_);
  return command;
}

void RobotSession::stop(Reason reason, const hardware::PlantFault& plant) noexcept {
  if (stage_ == SessionStage::off || stage_ == SessionStage::stopping) return;
  fault_ = {.reason = reason, .plant = plant, .phase = phase_};
  soft_stop_.reset();
  const bool flight = stage_ == SessionStage::active && phase_ == core::RobotPhase::flight;
  if (flight) {
    soft_stop_.begin_in_flight(readings_.stamp, landing_posture_);
  } else {
    soft_stop_.begin_on_ground(readings_.stamp);
  }
  stage_ = SessionStage::stopping;
}

void RobotSession::enable(SessionBrain brain) {
  HOPSCOTCH_CHECK(stage_ == SessionStage::off);
  brain_ = std::move(brain);
  fault_ = {};
  phase_ = core::RobotPhase::stand;
  plant_.notify_phase(phase_);
  plant_.set_power(hardware::DrivePower::on);
  stage_ = SessionStage::enabling;
  stage_since_ = readings_.stamp;
}

bool RobotSession::clear_fault() noexcept {
  if (stage_ != SessionStage::off) return false;
  fault_ = {};
  plant_.clear_fault();
  return true;
}

}  // namespace hopscotch::apps
