#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "apps/command_campaign.hpp"
#include "apps/command_library.hpp"
#include "apps/commands.hpp"
#include "apps/installation.hpp"
#include "core/config_reader.hpp"

using hopscotch::apps::Action;
using hopscotch::apps::ExitStatus;

int main(int argc, char** argv) {
  CLI::App app("Hopscotch: continuous bipedal jumping over terrain that the robot sees",
               "hopscotch");
  app.set_version_flag("--version", std::string(hopscotch::apps::program_version()));
  app.require_subcommand(1);
  Action action;
  hopscotch::apps::add_run_command(app, action);
  hopscotch::apps::add_plan_command(app, action);
  hopscotch::apps::add_library_command(app, action);
  hopscotch::apps::add_target_command(app, action);
  hopscotch::apps::add_command_command(app, action);
  hopscotch::apps::add_campaign_command(app, action);
  hopscotch::apps::add_calibrate_command(app, action);
  hopscotch::apps::add_replay_command(app, action);
  hopscotch::apps::add_scene_command(app, action);
  hopscotch::apps::add_report_command(app, action);
  hopscotch::apps::add_robot_command(app, action);
  hopscotch::apps::add_motors_command(app, action);
  hopscotch::apps::add_explain_command(app, action);
  hopscotch::apps::add_view_command(app, action);
  hopscotch::apps::add_doctor_command(app, action);
  hopscotch::apps::add_bench_command(app, action);
  hopscotch::apps::add_manual_command(app, action);
  try {
    app.parse(argc, argv);
    return static_cast<int>(action());
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = app.exit(error) == 0;
    return static_cast<int>(asked_for_help ? ExitStatus::ok : ExitStatus::bad_input);
  } catch (const hopscotch::core::ConfigError& error) {
    std::fprintf(stderr, "hopscotch: %s\n", error.what());
    return static_cast<int>(ExitStatus::bad_input);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hopscotch: %s\n", error.what());
    return static_cast<int>(ExitStatus::machine_lacks);
  }
}
