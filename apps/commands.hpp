#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace hopscotch::apps {

/// How the program ends; the numbers are part of its interface.
enum class ExitStatus : int {
  ok = 0,             ///< It did what was asked.
  answer_is_no = 1,   ///< It ran, and the answer is no.
  bad_input = 2,      ///< Bad usage or bad input.
  machine_lacks = 3,  ///< The machine lacks something.
};

/// Set by the subcommand that was named on the command line.
using Action = std::function<ExitStatus()>;

/// Each adds one subcommand with its options; the parsed subcommand stores what to do in `action`.
void add_run_command(CLI::App& app, Action& action);
void add_plan_command(CLI::App& app, Action& action);
void add_target_command(CLI::App& app, Action& action);
void add_command_command(CLI::App& app, Action& action);
void add_calibrate_command(CLI::App& app, Action& action);
void add_replay_command(CLI::App& app, Action& action);
void add_scene_command(CLI::App& app, Action& action);
void add_report_command(CLI::App& app, Action& action);
void add_robot_command(CLI::App& app, Action& action);
void add_motors_command(CLI::App& app, Action& action);
void add_explain_command(CLI::App& app, Action& action);
void add_view_command(CLI::App& app, Action& action);
void add_doctor_command(CLI::App& app, Action& action);
void add_bench_command(CLI::App& app, Action& action);
void add_manual_command(CLI::App& app, Action& action);

}  // namespace hopscotch::apps
