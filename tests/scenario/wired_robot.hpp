#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "apps/emulated_robot.hpp"
#include "apps/fault_script.hpp"
#include "apps/real_time.hpp"
#include "apps/robot_brain.hpp"
#include "apps/robot_config.hpp"
#include "apps/robot_session.hpp"
#include "core/allocation_count.hpp"
#include "sim/judge.hpp"

namespace hopscotch::apps::testing {

/// Robot and emulated drives in one process: the code that runs on the robot, on the emulated
/// buses.
class WiredRobot {
 public:
  explicit WiredRobot(const RobotConfig& config, core::DepthSource* eyes = nullptr)
      : world(emulated_robot_options(config)),
        script(config.emulation.faults),
        plant(config.plant, config.topology, config.robot, ports(config)),
        session(config, plant, landing_posture(config)),
        brain(config, eyes) {}

  void run(double seconds) {
    const core::Stamp end = world.now().after(seconds);
    while (world.now() < end) tick();
  }
  /// False when it does not come true in time.
  bool run_until(const std::function<bool()>& done, double seconds) {
    const core::Stamp end = world.now().after(seconds);
    while (world.now() < end && !done()) tick();
    return done();
  }
  void tick() {
    const std::size_t before = core::allocation_count();
    world_allocations_ = 0;
    session.tick();
    allocations = core::allocation_count() - before - world_allocations_;
    if (each_tick) each_tick(world.truth().state);
    if (!world.in_harness()) fallen = fallen || sim::fall_of(world.truth()).has_value();
  }
  /// Two exchanges to hear all drives, then the operator's word.
  void enable() {
    session.tick();
    session.tick();
    session.enable(brain.session_brain());
  }

  void ask(core::ModeRequest mode) {
    core::OperatorCommand command;
    command.sequence = ++asked_;
    command.mode = mode;
    brain.apply(command);
  }
  /// Enables, stands up and waits until the robot would jump.
  bool stand() {
    enable();
    return run_until([&] { return brain.ticked() && world.now().seconds() > 3.0; }, 5.0);
  }

  /// What the emulation takes from the heap is not the robot's.
  template <typename Work>
  auto apart(const Work& work) {
    const std::size_t before = core::allocation_count();
    auto result = work();
    world_allocations_ += core::allocation_count() - before;
    return result;
  }

  EmulatedRobot world;
  FaultScript script;
  hardware::RobotPlant plant;
  RobotSession session;
  RobotBrain brain;
  std::optional<PeriodicWake> wake;  ///< Set: exchanges wait for the clock.
  std::function<void(const core::RobotState& truth)> each_tick;
  bool fallen = false;
  int stall_ticks = 0;          ///< The host oversleeps its next exchange by so much.
  std::size_t allocations = 0;  ///< By the last exchange, without those of the emulation.

 private:
  std::uint64_t asked_ = 0;
  std::size_t world_allocations_ = 0;
  hardware::PlantPorts ports(const RobotConfig& config) {
    hardware::PlantPorts ports;
    for (std::size_t i = 0; i < config.topology.buses.size(); ++i) {
      const hardware::CanPort port = world.bus(i).host_port();
      ports.buses.push_back(
          {.send = [this, port](auto frames) { return apart([&] { return port.send(frames); }); },
           .receive = [this,
                       port](auto events) { return apart([&] { return port.receive(events); }); }});
    }
    ports.imu = [this] { return apart([&] { return world.imu(); }); };
    const int period = static_cast<int>(std::lround(1000.0 / config.topology.rate));
    ports.wait = [this, period] {
      if (wake) wake->wait();
      apart([&] {
        for (int i = 0; i < period + stall_ticks; ++i) {
          script.play(world);
          world.advance();
        }
        return 0;
      });
      stall_ticks = 0;
      return world.now();
    };
    return ports;
  }
};

inline RobotConfig wired_config() {
  RobotConfig config =
      RobotConfig::load(std::string(HOPSCOTCH_SOURCE_DIR) + "/config/robot_bus.yaml");
  config.pacing.mode = Pacing::Mode::lockstep;
  return config;
}

}  // namespace hopscotch::apps::testing
