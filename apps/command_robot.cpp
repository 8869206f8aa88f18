#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>

#include "apps/commands.hpp"
#include "apps/installation.hpp"
#include "apps/robot_program.hpp"

namespace hopscotch::apps {

namespace fs = std::filesystem;

namespace {

std::atomic<bool> interrupted{false};  // set by the signal handler, hence at namespace scope

extern "C" void on_robot_signal(int) {
  interrupted = true;
}

struct RobotOptions {
  fs::path config = config_directory() / "robot_bus.yaml";
  bool dry_run = false;
};

ExitStatus run_robot(const RobotOptions& options) {
  std::signal(SIGINT, on_robot_signal);
  std::signal(SIGTERM, on_robot_signal);
  RobotProgram program(RobotConfig::load(options.config),
                       options.dry_run ? RobotProgram::Wire::listen : RobotProgram::Wire::drive);
  return program.run(interrupted);
}

}  // namespace

void add_robot_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("robot", "The same autonomy on the hardware, over CAN");
  command->footer(
      "Example: hopscotch robot --dry-run\n"
      "Nothing moves before `hopscotch command enable`; read docs/hardware.md first.");
  const auto options = std::make_shared<RobotOptions>();  // shared with the action below
  command->add_option("--config", options->config, "Buses, drives and bring-up")
      ->capture_default_str();
  command->add_flag("--dry-run", options->dry_run,
                    "Read the joints only: drives are never enabled, no real-time rights needed");
  command->callback([&action, options] { action = [options] { return run_robot(*options); }; });
}

}  // namespace hopscotch::apps
