#include "apps/robot_program.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <stdexcept>

#include "core/allocation_count.hpp"
#include "hardware/can_interface.hpp"
#include "hardware/range_check.hpp"

namespace hopscotch::apps {

using core::ModeRequest;
using core::Reason;

namespace {

constexpr double kPatience = 20.0;  // for `motors` in lock-step to be there [s]

std::vector<hardware::CanBus> open_buses(const hardware::BusTopology& topology) {
  std::vector<hardware::CanBus> buses;
  for (std::size_t i = 0; i < topology.buses.size(); ++i) {
    const hardware::BusSetup& setup = topology.buses[i];
    hardware::CanBusOptions options{.interface_name = setup.interface_name,
                                    .identifiers = {},
                                    .flexible_data_rate = setup.data_bit_rate > 0.0};
    for (const hardware::DriveMount& drive : topology.drives) {
      if (drive.bus != i) continue;
      options.identifiers.push_back(drive.reply_id);
      options.identifiers.push_back(drive.id);  // to be confirmed, and to notice a second host
    }
    buses.emplace_back(options);
  }
  return buses;
}

}  // namespace

RobotProgram::RobotProgram(const RobotConfig& config, Wire wire)
    : config_(config),
      wire_(wire),
      buses_(open_buses(config.topology)),
      imu_(config.imu),
      plant_(config.plant, config.topology, config.robot, make_ports()),
      session_(config, plant_, landing_posture(config)),
      run_id_(wall_clock_us()),
      gate_(run_id_, run_id_),
      live_(live_url(), box_, run_id_),
      spare_brains_({.name = "preparation",
                     .threaded = config.pacing.mode == Pacing::Mode::real_time,
                     .thread = {}},
                    [this](std::unique_ptr<RobotBrain>& used, std::unique_ptr<RobotBrain>& spare) {
                      used.reset();
                      spare = make_brain();
                    }) {
  if (config.session.has_eyes) eyes_.emplace(live_url());
  spare_ = make_brain();
}

std::unique_ptr<RobotBrain> RobotProgram::make_brain() {
  return std::make_unique<RobotBrain>(config_, eyes_ ? &*eyes_ : nullptr);
}

hardware::PlantPorts RobotProgram::make_ports() {
  hardware::PlantPorts ports;
  for (hardware::CanBus& bus : buses_) ports.buses.push_back(bus.port());
  ports.imu = [this] { return imu_.poll(); };
  ports.wait = [this] {
    const std::optional<core::Stamp> now = step_ ? step_->grant() : wake_->wait();
    world_gone_ = !now;
    if (now) now_ = *now;
    return now_;
  };
  return ports;
}

bool RobotProgram::ranges_agree() {
  const hardware::RangeCheckResult check = hardware::check_ranges(config_.topology, make_ports());
  console_.say("robot: ranges of %d drives read back and right, %d drives cannot tell theirs",
               check.read, check.cannot_tell);
  if (check.problem.empty()) return true;
  std::fprintf(stderr, "robot: refused: %s\n", check.problem.c_str());
  return false;
}

/// Real drives would go limp between exchanges that are further apart than configured.
void RobotProgram::refuse_to_slow_a_robot_down() const {
  const std::vector<hardware::CanInterface> interfaces = hardware::can_interfaces();
  for (const hardware::BusSetup& bus : config_.topology.buses) {
    if (hardware::is_virtual(interfaces, bus.interface_name)) continue;
    throw std::runtime_error(bus.interface_name +
                             " is no virtual bus: drives are not driven by a slowed clock; fix: "
                             "`pacing.slowdown: 1`");
  }
}

/// In lock-step with the emulated drives, or by the clock with the rights that this takes.
void RobotProgram::start_time() {
  if (config_.pacing.mode == Pacing::Mode::lockstep) {
    step_.emplace(config_.pacing.socket, kPatience);
    return;
  }
  for (const std::string& refused :
       {lock_memory(), schedule_this_thread(config_.tuning.threads.control)}) {
    if (refused.empty()) continue;
    // Without these rights a busy machine makes the robot miss its exchanges.
    if (wire_ == Wire::drive) throw std::runtime_error(refused);
    std::fprintf(stderr, "robot: warning: %s\n", refused.c_str());
  }
  touch_stack();
  if (config_.pacing.slowdown > 1.0) refuse_to_slow_a_robot_down();
  wake_.emplace(1.0 / config_.topology.rate, config_.pacing.slowdown);
}

std::string RobotProgram::clock_text() const {
  std::array<char, 64> text{};
  const double slowdown = config_.pacing.slowdown;
  std::snprintf(text.data(), text.size(), "by the clock, %g times slowed", slowdown);
  return slowdown > 1.0 ? text.data() : "by the clock";
}

ExitStatus RobotProgram::run(const std::atomic<bool>& interrupted) {
  start_time();
  console_.say("robot: run %s, %zu buses at %.0f Hz, time %s%s", run_id_text(run_id_).c_str(),
               buses_.size(), config_.topology.rate,
               step_ ? "in lock-step with the emulated drives" : clock_text().c_str(),
               wire_ == Wire::listen ? ", drives stay off" : "");
  if (!ranges_agree()) return ExitStatus::answer_is_no;
  while (!world_gone_) {
    if (interrupted && !finishing_) {
      finishing_ = true;
      session_.stop_now();
    }
    if (finishing_ && session_.stage() == SessionStage::off) break;
    const std::size_t before = core::allocation_count();
    session_.tick();
    attend();
    if (core::allocation_count() != before) ++exchanges_with_heap_;
  }
  if (world_gone_) {
    std::fprintf(stderr, "robot: the emulated drives have gone\n");
    return ExitStatus::answer_is_no;
  }
  // Once more with the drives off, so that they hear it.
  session_.tick();
  session_.tick();
  console_.say("robot: stopped, drives off, after %.3f s", now_.seconds());
  print_counters();
  return ExitStatus::ok;
}

void RobotProgram::attend() {
  for (const core::OperatorCommand& command : box_.take_all()) {
    const core::Refusal refusal = gate_.check(command, wall_clock_us());
    if (refusal.reason == Reason::wrong_run) continue;  // somebody else's
    if (refusal.reason != Reason::none) {
      answer(command, refusal, "");
    } else {
      obey(command);
    }
  }
  if (brain_ && session_.stage() == SessionStage::active) {
    for (const core::OperatorAnswer& said : brain_->pipeline().events().answers) {
      if (said.command.sequence != 0) voice_.tell(now_, said);
    }
    if (const std::optional<core::Refusal> refusal = brain_->take_refusal()) {
      voice_.tell_refusal(now_, *refusal);
    }
    // The mission's end by the operator's stop: the robot stands, its drives go off.
    if (brain_->pipeline().end() == MissionEnd::stopped && !finishing_) {
      finishing_ = true;
      session_.stop_now();
    }
  }
  (void)spare_brains_.made();  // take() gives what that has shown
  if (std::unique_ptr<RobotBrain>* const spare = spare_brains_.take(now_)) {
    spare_ = std::move(*spare);
  }
  voice_.tell(now_, session_, brain_.get());
  if (wire_ == Wire::listen) voice_.tell_joints(now_, session_, plant_);
}

void RobotProgram::obey(const core::OperatorCommand& command) {
  const SessionStage stage = session_.stage();
  switch (command.mode) {
    case ModeRequest::enable: return enable(command);
    case ModeRequest::damp:
      if (stage == SessionStage::off) {
        return answer(command, {Reason::not_now, "the drives are off"}, "");
      }
      session_.stop_now();
      return answer(command, {}, "the robot is brought to rest and its drives go off");
    case ModeRequest::clear_fault:
      if (!session_.clear_fault()) {
        return answer(command, {Reason::not_now, "the drives are not off yet"}, "");
      }
      return answer(command, {}, "cleared: `hopscotch command enable` when the robot is home");
    case ModeRequest::stop:
      if (stage == SessionStage::off) {
        finishing_ = true;
        return answer(command, {}, "the drives are off already; the program ends");
      }
      break;
    case ModeRequest::jump:
    case ModeRequest::hold:
    case ModeRequest::none: break;
  }
  if (stage != SessionStage::active || !brain_->ticked()) {
    return answer(command,
                  {Reason::not_now, "the robot is " + std::string(session_stage_name(stage)) +
                                        ": it does not stand yet"},
                  "");
  }
  brain_->apply(command);
}

void RobotProgram::enable(const core::OperatorCommand& command) {
  if (wire_ == Wire::listen) {
    return answer(command, {Reason::not_now, "--dry-run: the drives stay off"}, "");
  }
  const std::string obstacle = session_.obstacle();
  if (!obstacle.empty()) return answer(command, {Reason::not_homed, obstacle}, "");
  if (!spare_) {
    return answer(command, {Reason::not_now, "the controller is still being made ready"}, "");
  }
  std::swap(brain_, spare_);
  session_.enable(brain_->session_brain());
  spare_brains_.question() = std::move(spare_);
  spare_brains_.ask(now_);
  answer(command, {}, "the drives turn on and the robot stands up, then waits for `command jump`");
}

void RobotProgram::answer(const core::OperatorCommand& command, const core::Refusal& refusal,
                          const std::string& remark) {
  core::OperatorAnswer said;
  said.command = command;
  said.refusal = refusal;
  said.remark = remark;
  voice_.tell(now_, said);
}

void RobotProgram::print_counters() {
  const hardware::PlantCounters& wire = plant_.counters();
  const auto number = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
  console_.say(
      "robot: %llu exchanges, %llu late; answers: %llu taken, %llu missing, %llu malformed, "
      "%llu from the wrong drive, %llu implausible; frames not taken %llu, bus errors %llu, "
      "foreign commands %llu",
      number(wire.exchanges), number(session_.deadlines().late), number(wire.replies),
      number(wire.lost_replies), number(wire.malformed), number(wire.wrong_sender),
      number(wire.implausible), number(wire.not_sent), number(wire.bus_errors),
      number(wire.foreign));
  // In lock-step the loop plans as well.
  if (wake_) {
    console_.say("robot: the loop took memory from the heap in %llu exchanges",
                 number(exchanges_with_heap_));
  }
}

}  // namespace hopscotch::apps
