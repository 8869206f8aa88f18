#include "hardware/robot_plant.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace hopscotch::hardware {

using core::DriveMode;
using core::JointVector;
using core::Range;
using core::Reason;

namespace {

constexpr int kEnterFrames = 3;  // drives that do not tell are taken for on after so many
constexpr int kClearFrames = 3;
constexpr int kWrongSenders = 3;  // in a row: no accident

/// What answers any command and lets nothing move.
constexpr DriveSetpoint kNoEffort{};

PlantFault bus_fault(std::size_t bus, BusTrouble trouble) noexcept {
  return {.reason = Reason::bus_fault, .bus = static_cast<int>(bus), .trouble = trouble};
}

std::string_view trouble_text(BusTrouble trouble) {
  switch (trouble) {
    case BusTrouble::none: break;
    case BusTrouble::off: return " is off the bus";
    case BusTrouble::passive: return " is error passive";
    case BusTrouble::not_taken: return " does not take frames: its queue is full, or it is down";
    case BusTrouble::not_confirmed: return " does not confirm that frames have been sent";
  }
  return " is in trouble";
}

}  // namespace

RobotPlantConfig RobotPlantConfig::load(const core::ConfigReader& section) {
  RobotPlantConfig config;
  config.guard = CommandGuardConfig::load(section.section("command_guard"));
  config.stale_cycles_ground = section.integer("stale_cycles_ground", 1, 100);
  config.stale_cycles_flight = section.integer("stale_cycles_flight", 1, 100);
  config.imu_age_max = 1e-3 * section.number("imu_age_max_ms", Range::above(0.0, 100.0));
  config.temperature_max_degC = section.number("temperature_max_degC", Range::closed(30.0, 150.0));
  config.stuck_time = 1e-3 * section.number("stuck_time_ms", Range::positive());
  config.stuck_travel = section.number("stuck_travel_rad", Range::positive());
  config.start_damping = section.number("start_damping_Nms_per_rad", Range::not_negative());
  section.finish();
  return config;
}

std::string describe(const PlantFault& fault, const BusTopology& topology) {
  if (fault.reason == Reason::none) return "";
  if (fault.joint >= 0) {
    const DriveMount& drive = topology.drives[static_cast<std::size_t>(fault.joint)];
    const std::string who = joint_name(fault.joint) + " (drive " + std::to_string(drive.id) +
                            " on " + topology.buses[drive.bus].interface_name + ") ";
    switch (fault.reason) {
      case Reason::drive_silent: return who + "does not answer";
      case Reason::drive_fault:
        return who + (fault.drive == DriveFault::none
                          ? "has left motor mode or is too hot"
                          : "reports " + std::string(drive_fault_name(fault.drive)));
      case Reason::drive_mismatch:
        return who + "is answered for by another drive: swapped identifiers";
      case Reason::encoder_stuck: return who + "always reports the same position";
      default: break;
    }
  }
  if (fault.bus >= 0) {
    return topology.buses[static_cast<std::size_t>(fault.bus)].interface_name +
           std::string(trouble_text(fault.trouble));
  }
  if (fault.reason == Reason::imu_lost) return "the IMU is silent";
  return std::string(core::reason_code(fault.reason));
}

RobotPlant::RobotPlant(const RobotPlantConfig& config, const BusTopology& topology,
                       const model::RobotParameters& robot, PlantPorts ports)
    : config_(config),
      topology_(topology),
      ports_(std::move(ports)),
      guard_(config.guard, robot),
      period_(1.0 / topology.rate) {
  HOPSCOTCH_CHECK(ports_.buses.size() == topology.buses.size());
  HOPSCOTCH_CHECK(topology.buses.size() <= kBusesMax);
  for (auto& bus : joint_of_) bus.fill(-1);
  for (std::size_t joint = 0; joint < core::kJoints; ++joint) {
    const DriveMount& drive = topology.drives[joint];
    joint_of_[drive.bus][drive.reply_id] = static_cast<std::int8_t>(joint);
  }
}

core::SensorReadings RobotPlant::exchange(const core::JointCommand& command) {
  const core::Stamp begun = now_;
  const bool clock_ran = clock_runs_;
  write_commands(command);
  now_ = ports_.wait();
  read_buses();
  read_imu();
  close_exchange();
  find_faults();
  ++counters_.exchanges;
  return readings(clock_ran ? begun : now_);
}

void RobotPlant::write_commands(const core::JointCommand& command) {
  for (Outbox& outbox : outboxes_) outbox.count = 0;
  const bool commands = powered() && command.mode != DriveMode::idle;
  if (commands) {
    core::JointCommand safe;
    static_cast<void>(guard_.filter(command, q_, dq_, safe));
    // With a reading missing there is nothing to turn about: the guard has damped, and damping
    // needs no angle but a finite one.
    const JointVector q = q_.allFinite() ? q_ : JointVector::Zero();
    const JointVector dq = dq_.allFinite() ? dq_ : JointVector::Zero();
    setpoints_ = drive_setpoints(topology_, safe, q, dq);
  } else {
    setpoints_.fill(kNoEffort);
  }
  for (std::size_t joint = 0; joint < core::kJoints; ++joint) {
    drives_[joint].fresh = false;
    Outbox& outbox = outboxes_[topology_.drives[joint].bus];
    outbox.frames[outbox.count++] = frame_for(joint, setpoints_[joint]);
  }
  clear_frames_ = std::max(0, clear_frames_ - 1);
  for (std::size_t bus = 0; bus < ports_.buses.size(); ++bus) {
    Outbox& outbox = outboxes_[bus];
    const std::size_t taken = ports_.buses[bus].send({outbox.frames.data(), outbox.count});
    outbox.unconfirmed += taken;
    counters_.not_sent += outbox.count - taken;
    if (taken < outbox.count) latch(bus_fault(bus, BusTrouble::not_taken));
  }
}

CanFrame RobotPlant::frame_for(std::size_t joint, const DriveSetpoint& setpoint) noexcept {
  const DriveMount& mount = topology_.drives[joint];
  const auto special = [&](SpecialCommand command) {
    return encode_special(mount.family, mount.id, command).value_or(CanFrame{});
  };
  const bool clears =
      encode_special(mount.family, mount.id, SpecialCommand::clear_error).has_value();
  if (clear_frames_ > 0 && clears) return special(SpecialCommand::clear_error);
  if (power_ == DrivePower::off) return special(SpecialCommand::exit_motor_mode);
  DriveSetpoint wanted = setpoint;
  if (!started_) {
    // A drive that drops out later stays out: only the operator turns it on again.
    if (!reports_[joint].on) {
      ++drives_[joint].enter_frames;
      return special(SpecialCommand::enter_motor_mode);
    }
    wanted.kd = config_.start_damping / (mount.gear * mount.gear);
  }
  CanFrame frame;
  const EncodeStatus status = encode_setpoint(mount.family, mount.id, wanted, frame);
  if (status == EncodeStatus::clamped) ++counters_.clamped;
  // Cannot happen behind the guard; silence lets the drive's watchdog act.
  if (status == EncodeStatus::not_finite) return special(SpecialCommand::exit_motor_mode);
  return frame;
}

void RobotPlant::read_buses() {
  std::array<CanEvent, 32> events;
  constexpr int kRounds = 16;  // bounded: a flooded bus must not hold the tick
  for (std::size_t bus = 0; bus < ports_.buses.size(); ++bus) {
    for (int round = 0; round < kRounds; ++round) {
      const std::size_t count = ports_.buses[bus].receive(events);
      for (std::size_t i = 0; i < count; ++i) read_event(bus, events[i]);
      if (count < events.size()) break;
    }
  }
}

void RobotPlant::read_event(std::size_t bus, const CanEvent& event) {
  switch (event.kind) {
    case CanEvent::Kind::confirmed:
      if (outboxes_[bus].unconfirmed > 0) --outboxes_[bus].unconfirmed;
      return;
    case CanEvent::Kind::error:
      ++counters_.bus_errors;
      if (event.errors.bus_off) latch(bus_fault(bus, BusTrouble::off));
      if (event.errors.passive) latch(bus_fault(bus, BusTrouble::passive));
      return;
    case CanEvent::Kind::received: break;
  }
  const std::int8_t joint =
      event.frame.id < kIdentifiers ? joint_of_[bus][event.frame.id] : std::int8_t{-1};
  if (joint >= 0) {
    read_reply(static_cast<std::size_t>(joint), event.frame);
    return;
  }
  const bool ours = std::any_of(
      topology_.drives.begin(), topology_.drives.end(),
      [&](const DriveMount& drive) { return drive.bus == bus && drive.id == event.frame.id; });
  ++(ours ? counters_.foreign : counters_.malformed);
}

void RobotPlant::read_reply(std::size_t joint, const CanFrame& frame) {
  const DriveMount& mount = topology_.drives[joint];
  Drive& drive = drives_[joint];
  DriveReply reply;
  if (decode_reply(mount.family, frame, reply) != DecodeStatus::ok) {
    ++counters_.malformed;
    return;
  }
  if (reply.drive_id != mount.id) {
    ++counters_.wrong_sender;
    if (++drive.wrong_senders >= kWrongSenders) {
      latch({.reason = Reason::drive_mismatch, .joint = static_cast<int>(joint)});
    }
    return;
  }
  drive.wrong_senders = 0;
  if (!plausible(joint, reply)) {
    ++counters_.implausible;
    return;
  }
  watch_encoder(joint, reply);
  drive.position = reply.position;
  drive.speed = reply.speed;
  drive.torque = reply.torque;
  drive.fresh = true;
  drive.fault = reply.fault;
  drive.temperature_degC = std::fmax(reply.temperature_degC, reply.rotor_temperature_degC);
  DriveReport& report = reports_[joint];
  report.heard = true;
  report.age = 0;
  report.on =
      reply.enabled.value_or(power_ == DrivePower::on && drive.enter_frames >= kEnterFrames);
  report.temperature_degC = drive.temperature_degC;
  ++counters_.replies;
}

/// A shaft cannot get farther between two answers than its fastest speed brings it.
bool RobotPlant::plausible(std::size_t joint, const DriveReply& reply) const {
  const Drive& drive = drives_[joint];
  // Without power a shaft may be turned by hand and the drive restarted: everything is news.
  if (std::isnan(drive.position) || power_ == DrivePower::off) return true;
  constexpr double kSlack = 0.05;  // encoder noise and play [rad]
  const double cycles = reports_[joint].age + 1;
  const double farthest = topology_.drives[joint].family.speed_max * cycles * period_;
  return std::abs(reply.position - drive.position) <= farthest + kSlack;
}

/// A position that stays the same to the last bit while the joint turns by its own speed reading,
/// or should have followed its set-point: the encoder hangs. A joint at rest has neither.
void RobotPlant::watch_encoder(std::size_t joint, const DriveReply& reply) {
  Drive& drive = drives_[joint];
  const bool active = powered() && setpoints_[joint].kp > 0.0;
  if (!active || reply.position != drive.position) {
    drive.still_time = 0.0;
    drive.still_travel = 0.0;
    return;
  }
  const double gear = topology_.drives[joint].gear;
  constexpr double kNoise = 0.1;  // of a speed reading, with its rounding [rad/s]
  const double speed = std::max(std::abs(reply.speed), std::abs(setpoints_[joint].speed)) / gear;
  drive.still_time += period_;
  drive.still_travel += period_ * std::max(0.0, speed - kNoise);
  if (drive.still_time >= config_.stuck_time && drive.still_travel >= config_.stuck_travel) {
    latch({.reason = Reason::encoder_stuck, .joint = static_cast<int>(joint)});
  }
}

void RobotPlant::read_imu() {
  if (const std::optional<ImuSample> sample = ports_.imu()) {
    imu_ = sample;
    imu_stamp_ = now_;
  }
}

/// Ages the drives and turns what is known of the shafts into joints.
void RobotPlant::close_exchange() {
  ShaftStates shafts;
  bool complete = true;
  for (std::size_t joint = 0; joint < core::kJoints; ++joint) {
    const Drive& drive = drives_[joint];
    if (!drive.fresh) {
      ++counters_.lost_replies;
      ++reports_[joint].age;
    }
    complete = complete && reports_[joint].heard;
    shafts.position[joint] = drive.position;
    shafts.speed[joint] = drive.speed;
    shafts.torque[joint] = drive.torque;
  }
  if (!complete) return;
  const JointStates joints = joint_states(topology_, shafts);
  q_ = joints.q;
  dq_ = joints.dq;
  tau_ = joints.tau;
}

void RobotPlant::find_faults() {
  clock_runs_ = true;
  if (power_ == DrivePower::off) return;
  started_ = started_ || std::all_of(reports_.begin(), reports_.end(),
                                     [](const DriveReport& report) { return report.on; });
  const bool flight = phase_ == core::RobotPhase::flight;
  const int stale = flight ? config_.stale_cycles_flight : config_.stale_cycles_ground;
  for (std::size_t joint = 0; joint < core::kJoints; ++joint) {
    const auto at = static_cast<int>(joint);
    const Drive& drive = drives_[joint];
    if (reports_[joint].age >= stale) latch({.reason = Reason::drive_silent, .joint = at});
    if (drive.fault.value_or(DriveFault::none) != DriveFault::none) {
      latch({.reason = Reason::drive_fault, .joint = at, .drive = *drive.fault});
    }
    const bool left_motor_mode = started_ && !reports_[joint].on;
    if (left_motor_mode || drive.temperature_degC > config_.temperature_max_degC) {
      latch({.reason = Reason::drive_fault, .joint = at});
    }
  }
  for (std::size_t bus = 0; bus < ports_.buses.size(); ++bus) {
    // The last exchange's frames may still be on their way, those before may not.
    if (outboxes_[bus].unconfirmed > outboxes_[bus].count) {
      latch(bus_fault(bus, BusTrouble::not_confirmed));
    }
  }
  if (!imu_ || now_.since(imu_stamp_) > config_.imu_age_max) latch({.reason = Reason::imu_lost});
}

void RobotPlant::latch(const PlantFault& fault) noexcept {
  if (power_ == DrivePower::on && fault_.reason == Reason::none) fault_ = fault;
}

void RobotPlant::set_power(DrivePower power) noexcept {
  if (power == power_) return;
  power_ = power;
  started_ = false;
  setpoints_.fill(kNoEffort);
  for (std::size_t joint = 0; joint < core::kJoints; ++joint) {
    drives_[joint].enter_frames = 0;
    drives_[joint].still_time = 0.0;
    drives_[joint].still_travel = 0.0;
    reports_[joint].on = false;
  }
}

void RobotPlant::clear_fault() noexcept {
  fault_ = {};
  clear_frames_ = kClearFrames;
  for (Outbox& outbox : outboxes_) outbox.unconfirmed = 0;
  for (Drive& drive : drives_) {
    drive.fault.reset();
    drive.wrong_senders = 0;
  }
}

core::SensorReadings RobotPlant::readings(core::Stamp stamp) const {
  core::SensorReadings readings;
  readings.stamp = stamp;
  readings.q = q_;
  readings.dq = dq_;
  readings.tau = tau_;
  if (imu_) {
    readings.w_WB_B = imu_->rate;
    readings.f_B = imu_->force;
  }
  return readings;
}

}  // namespace hopscotch::hardware
