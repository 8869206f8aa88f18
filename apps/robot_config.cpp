#include "apps/robot_config.hpp"

#include "apps/installation.hpp"

namespace hopscotch::apps {

using core::ConfigReader;
using core::Range;

namespace fs = std::filesystem;

SessionConfig SessionConfig::load(const ConfigReader& section) {
  SessionConfig config;
  config.ramp = section.number("ramp_s", Range::closed(0.5, 10.0));  // shorter jerks the legs
  config.settle = section.number("settle_s", Range::closed(0.0, 60.0));
  config.enable_timeout = section.number("enable_timeout_s", Range::above(0.0, 60.0));
  config.has_eyes = section.choice("floor", {"level", "camera"}) == 1;
  config.jump_distance = section.number("jump_m", Range::closed(0.06, 0.55));
  config.jumps_per_command = section.integer("jumps_per_command", 0, 1'000'000);
  section.finish();
  return config;
}

Pacing Pacing::load(const ConfigReader& section) {
  Pacing pacing;
  pacing.mode = static_cast<Mode>(section.choice("mode", {"real_time", "lockstep"}));
  pacing.slowdown = section.number_or("slowdown", 1.0, Range::closed(1.0, 1000.0));
  pacing.socket = section.text("socket");
  if (pacing.socket.empty() || pacing.socket.size() > 90) {
    section.reject("socket", "must be a name of 1 to 90 characters");
  }
  section.finish();
  return pacing;
}

EmulationConfig EmulationConfig::load(const ConfigReader& section, const fs::path& folder) {
  EmulationConfig config;
  config.scenario = sim::Scenario::load(folder / section.text("scenario"));
  config.seed = static_cast<std::uint64_t>(section.integer("seed", 0, 1'000'000'000));
  config.watchdog = 1e-3 * section.number("watchdog_ms", Range::closed(2.0, 1000.0));
  config.harness = section.number("harness_s", Range::closed(0.0, 60.0));
  config.bus_error_share = section.number("bus_error_share", Range::closed(0.0, 1.0));
  for (const ConfigReader& fault : section.list_if("faults")) {
    config.faults.push_back(ScriptedFault::load(fault));
  }
  section.finish();
  return config;
}

RobotConfig RobotConfig::load(const fs::path& file) {
  const ConfigReader root = ConfigReader::from_file(file);
  const fs::path folder = file.parent_path();
  RobotConfig config;
  config.robot = model::RobotParameters::load(robot_file(root.text("robot")));
  config.tuning = ProgramConfig::load(folder / root.text("tuning"));
  config.topology = hardware::BusTopology::load(root, config_directory() / "drives");
  config.imu = hardware::ImuSetup::load(root.section("imu"));
  config.homing = hardware::HomingConfig::load(root.section("homing"));
  config.plant = hardware::RobotPlantConfig::load(root.section("plant"));
  config.soft_stop = hardware::SoftStopConfig::load(root.section("soft_stop"));
  config.session = SessionConfig::load(root.section("session"));
  config.pacing = Pacing::load(root.section("pacing"));
  config.emulation = EmulationConfig::load(root.section("emulation"), folder);
  root.finish();
  const std::string problem = hardware::range_problem(config.topology, config.robot);
  if (!problem.empty()) root.reject("drives", problem);
  return config;
}

}  // namespace hopscotch::apps
