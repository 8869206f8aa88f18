#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/fault_script.hpp"
#include "apps/program_config.hpp"
#include "hardware/bus_topology.hpp"
#include "hardware/homing.hpp"
#include "hardware/imu.hpp"
#include "hardware/robot_plant.hpp"
#include "hardware/soft_stop.hpp"
#include "model/robot_parameters.hpp"
#include "sim/scenario.hpp"

namespace hopscotch::apps {

/// From enabling to jumping; section `session`.
struct SessionConfig {
  double ramp = 0.0;            ///< Gains rise from zero to the controller's over so long [s].
  double settle = 0.0;          ///< Holding the pose afterwards [s].
  double enable_timeout = 0.0;  ///< [s]
  bool has_eyes = false;        ///< Ground by the depth camera; else a level floor is vouched for.
  double jump_distance = 0.0;   ///< That is aimed at [m].
  int jumps_per_command = 0;    ///< Then it holds; 0: it goes on.

  static SessionConfig load(const core::ConfigReader& section);
};

/// How time passes for `robot` and `motors`; section `pacing`.
struct Pacing {
  enum class Mode : std::uint8_t { real_time, lockstep };
  Mode mode = Mode::real_time;
  double slowdown = 1.0;  ///< A second of the robot's clock takes so many; more than 1 on virtual
                          ///< buses only. Optional. Without effect in lock-step.
  std::string socket;     ///< Name of the abstract Unix socket that the two meet at in lock-step.

  static Pacing load(const core::ConfigReader& section);
};

/// The world behind `hopscotch motors`; section `emulation`.
struct EmulationConfig {
  sim::Scenario scenario;
  std::uint64_t seed = 1;
  double watchdog = 0.0;         ///< Of the drives [s].
  double harness = 0.0;          ///< The robot hangs for so long after all drives are on [s].
  double bus_error_share = 0.0;  ///< Frames destroyed by noise.
  std::vector<ScriptedFault> faults;

  static EmulationConfig load(const core::ConfigReader& section,
                              const std::filesystem::path& folder);
};

/// `config/robot_bus.yaml`, whole, with the tuning it names.
struct RobotConfig {
  ProgramConfig tuning;
  model::RobotParameters robot;
  hardware::BusTopology topology;
  hardware::RobotPlantConfig plant;
  hardware::SoftStopConfig soft_stop;
  hardware::HomingConfig homing;
  hardware::ImuSetup imu;
  SessionConfig session;
  Pacing pacing;
  EmulationConfig emulation;

  /// @throws core::ConfigError naming file, line, key, value and rule; also where a drive's range
  /// cannot carry its joint's torque or speed.
  static RobotConfig load(const std::filesystem::path& file);
};

}  // namespace hopscotch::apps
