#include <cmath>
#include <memory>

#include "apps/command_operator.hpp"
#include "apps/option_check.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

struct TargetOptions {
  core::TargetOverride target;
  bool clear = false;
  AskOptions ask;
};

ExitStatus target(const TargetOptions& options) {
  if (!options.clear && std::isnan(options.target.distance)) {
    throw core::ConfigError("target: give either DISTANCE_M or --clear");
  }
  core::OperatorCommand command;
  if (options.clear) {
    command.clear_target = true;
  } else {
    command.target = options.target;
  }
  return ask_run(options.ask, command);
}

}  // namespace

void add_target_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "target", "Overrides the next landing target of a running program and prints its answer");
  command->footer(
      "The place is judged like any other: by map, reach and the plan's certificate. It holds for "
      "one jump, the next to take off; one under way is locked.\nExit status 0: accepted, 1: "
      "refused or nobody answered.\n"
      "Example: hopscotch target 0.35 0.05       35 cm ahead, 5 cm up\n"
      "         hopscotch target 0.3 --yaw 0.1   with a turn to the left\n"
      "         hopscotch target --clear         drop it again");
  const auto options = std::make_shared<TargetOptions>();  // shared with the action below
  CLI::Option* const clear =
      command->add_flag("--clear", options->clear, "Drop an earlier target that is still waiting");
  command->add_option("DISTANCE_M", options->target.distance, "Along the heading, sole to sole")
      ->check(finite_number())
      ->excludes(clear);
  command->add_option("HEIGHT_M", options->target.height, "Expected height; without it the map's")
      ->check(finite_number())
      ->excludes(clear);
  command->add_option("--lateral", options->target.lateral, "To the left [m]")
      ->check(finite_number())
      ->excludes(clear);
  command->add_option("--yaw", options->target.yaw, "Turn to the left [rad]")
      ->check(finite_number())
      ->excludes(clear);
  add_ask_options(*command, options->ask);
  command->callback([&action, options] { action = [options] { return target(*options); }; });
}

}  // namespace hopscotch::apps
