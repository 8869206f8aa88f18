#include <poll.h>

#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <vector>

#include "apps/commands.hpp"
#include "apps/emulated_eyes.hpp"
#include "apps/emulated_robot.hpp"
#include "apps/fault_script.hpp"
#include "apps/installation.hpp"
#include "apps/live_run.hpp"
#include "apps/real_time.hpp"
#include "apps/robot_config.hpp"
#include "apps/step_link.hpp"
#include "hardware/can_bus.hpp"
#include "sim/judge.hpp"

namespace hopscotch::apps {

namespace fs = std::filesystem;

namespace {

std::atomic<bool> interrupted{false};  // set by the signal handler, hence at namespace scope

extern "C" void on_motors_signal(int) {
  interrupted = true;
}

/// Emulated drives on real SocketCAN interfaces.
class MotorsProgram {
 public:
  explicit MotorsProgram(const RobotConfig& config)
      : config_(config),
        world_(emulated_robot_options(config)),
        script_(config.emulation.faults),
        imu_(config.imu.device) {
    for (std::size_t i = 0; i < config.topology.buses.size(); ++i) {
      const hardware::BusSetup& setup = config.topology.buses[i];
      hardware::CanBusOptions options{.interface_name = setup.interface_name,
                                      .identifiers = {hardware::kRegisterIdentifier},
                                      .flexible_data_rate = setup.data_bit_rate > 0.0};
      for (const hardware::DriveMount& drive : config.topology.drives) {
        if (drive.bus == i) options.identifiers.push_back(drive.id);
      }
      buses_.emplace_back(options);
    }
    if (config.session.has_eyes) {
      eyes_.emplace(config.emulation.scenario, config.robot, config.emulation.seed, live_url(),
                    config.pacing.mode);
    }
  }

  /// As long as nobody interrupts: lives a period whenever the robot grants one.
  void follow_the_robot() {
    StepFollower link(config_.pacing.socket);
    const int period = static_cast<int>(std::lround(1000.0 / config_.topology.rate));
    std::printf("motors: waiting for a robot at '%s', time in lock-step with it\n",
                config_.pacing.socket.c_str());
    std::fflush(stdout);
    while (!interrupted) {
      constexpr int kLookUp = 200;  // [ms], to notice the interrupt
      const StepFollower::Event event = link.wait(kLookUp);
      if (event == StepFollower::Event::robot_gone) return robot_has_gone();
      if (event != StepFollower::Event::granted) continue;
      for (int i = 0; i < period; ++i) live_one_tick();
      link.done(world_.now());
    }
  }

  /// One millisecond per millisecond of the clock, slowed as configured; drives answer at once.
  void run_in_real_time() {
    const double slowdown = config_.pacing.slowdown;
    std::printf("motors: by the clock, a second takes %g s\n", slowdown);
    std::fflush(stdout);
    timespec next{};
    clock_gettime(CLOCK_MONOTONIC, &next);
    while (!interrupted) {
      const std::int64_t end = next.tv_nsec + std::llround(1e6 * slowdown);
      next = {.tv_sec = next.tv_sec + end / 1'000'000'000, .tv_nsec = end % 1'000'000'000};
      answer_until(next);
      script_.play(world_);
      world_.advance();
      send_imu();
      look(slowed_clock(slowdown));
      report();
    }
  }

 private:
  void live_one_tick() {
    script_.play(world_);
    std::array<hardware::CanEvent, 64> events;
    for (std::size_t i = 0; i < buses_.size(); ++i) {
      const std::size_t count = buses_[i].receive(events);
      for (std::size_t k = 0; k < count; ++k) {
        if (events[k].kind != hardware::CanEvent::Kind::received) continue;
        world_.bus(i).send({&events[k].frame, 1});
      }
    }
    world_.advance();
    for (std::size_t i = 0; i < buses_.size(); ++i) {
      const std::size_t count = world_.bus(i).receive(events);
      for (std::size_t k = 0; k < count; ++k) pass_on(buses_[i], events[k]);
    }
    send_imu();
    look(world_.now());
    report();
  }

  void look(core::Stamp robot_time) {
    if (eyes_) eyes_->look(world_.truth().state, robot_time);
  }

  /// The kernel confirms the robot's own frames itself; the rest of what the model says goes out.
  static void pass_on(hardware::CanBus& bus, const hardware::CanEvent& event) {
    if (event.kind == hardware::CanEvent::Kind::received) bus.send({&event.frame, 1});
    if (event.kind == hardware::CanEvent::Kind::error && event.errors.bus_off) bus.send_bus_off();
  }

  void answer_until(const timespec& end) {
    std::vector<pollfd> waited;
    for (const hardware::CanBus& bus : buses_) {
      waited.push_back({.fd = bus.descriptor(), .events = POLLIN, .revents = 0});
    }
    while (true) {
      timespec now{};
      clock_gettime(CLOCK_MONOTONIC, &now);
      const long long left =
          (end.tv_sec - now.tv_sec) * 1'000'000'000LL + end.tv_nsec - now.tv_nsec;
      if (left <= 0) return;
      const timespec timeout{.tv_sec = 0, .tv_nsec = static_cast<long>(left)};
      if (ppoll(waited.data(), waited.size(), &timeout, nullptr) <= 0) return;
      for (std::size_t i = 0; i < buses_.size(); ++i) {
        if ((waited[i].revents & POLLIN) != 0) answer_bus(i);
      }
    }
  }

  void answer_bus(std::size_t bus) {
    std::array<hardware::CanEvent, hardware::CanBus::kBatch> events;
    const std::size_t count = buses_[bus].receive(events);
    std::vector<hardware::CanFrame> answers;  // one system call for all
    for (std::size_t i = 0; i < count; ++i) {
      if (events[i].kind != hardware::CanEvent::Kind::received) continue;
      const auto more = world_.answer(bus, events[i].frame);
      answers.insert(answers.end(), more.begin(), more.end());
    }
    if (!answers.empty()) buses_[bus].send(answers);
  }

  void send_imu() {
    if (const auto sample = world_.imu()) imu_.write(*sample);
  }

  void report() {
    if (was_in_harness_ && !world_.in_harness()) {
      std::printf("motors: %.3f s: out of the harness\n", world_.now().seconds());
      was_in_harness_ = false;
    }
    constexpr std::int64_t kEvery = 500'000'000;  // [ns]
    if (world_.in_harness() || world_.now().nanoseconds % kEvery != 0) return;
    const sim::PlantTruth truth = world_.truth();
    const std::optional<std::string> fall = sim::fall_of(truth);
    std::printf("motors: %.1f s: trunk at x %.3f z %.3f m%s%s\n", world_.now().seconds(),
                truth.state.p_WB.x(), truth.state.p_WB.z(), fall ? ", down: " : "",
                fall.value_or("").c_str());
    std::fflush(stdout);
  }

  /// The drives go on alone until the watchdog has made all of them limp.
  void robot_has_gone() {
    const double after = 2.0 * config_.emulation.watchdog;
    for (int i = 0; i < static_cast<int>(1000.0 * after); ++i) live_one_tick();
    int on = 0;
    for (int joint = 0; joint < core::kJoints; ++joint) on += world_.drive(joint).in_motor_mode();
    std::printf(
        "motors: the robot's program has gone; %d drives still in motor mode after %.0f ms\n", on,
        1e3 * after);
    std::fflush(stdout);
  }

  RobotConfig config_;
  EmulatedRobot world_;
  FaultScript script_;
  hardware::SerialImuEnd imu_;
  std::optional<EmulatedEyes> eyes_;
  std::vector<hardware::CanBus> buses_;
  bool was_in_harness_ = true;
};

ExitStatus run_motors(const fs::path& file) {
  MotorsProgram program(RobotConfig::load(file));
  std::signal(SIGINT, on_motors_signal);
  std::signal(SIGTERM, on_motors_signal);
  const bool lockstep = RobotConfig::load(file).pacing.mode == Pacing::Mode::lockstep;
  lockstep ? program.follow_the_robot() : program.run_in_real_time();
  return ExitStatus::ok;
}

}  // namespace

void add_motors_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "motors", "The emulated drives: HECTOR in MuJoCo behind the robot's CAN frames");
  command->footer("Example: hopscotch motors --config config/robot_bus.yaml");
  const auto file = std::make_shared<fs::path>(config_directory() / "robot_bus.yaml");
  command->add_option("--config", *file, "Buses, drives and emulation")->capture_default_str();
  command->callback([&action, file] { action = [file] { return run_motors(*file); }; });
}

}  // namespace hopscotch::apps
