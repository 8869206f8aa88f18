#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include <unistd.h>

#include "apps/command_library.hpp"
#include "apps/installation.hpp"
#include "apps/program_config.hpp"
#include "apps/shipped_jumps.hpp"
#include "apps/stopwatch.hpp"
#include "apps/text_file.hpp"
#include "model/robot_parameters.hpp"
#include "planner/library_compiler.hpp"

namespace hopscotch::apps {

namespace {

struct LibraryOptions {
  std::string robot = "hector";
  std::filesystem::path config = config_directory() / "hopscotch.yaml";
  std::filesystem::path out;
  bool json = false;
};

/// On a terminal, every percent.
void show_progress(double share) {
  static const bool terminal = isatty(STDERR_FILENO) != 0;
  const int percent = static_cast<int>(100.0 * share);
  if (terminal) std::fprintf(stderr, "\rsolving: at most %3d %% left ", 100 - percent);
}

ExitStatus compile(const LibraryOptions& options) {
  const ProgramConfig config = ProgramConfig::load(options.config);
  const model::RobotParameters robot = model::RobotParameters::load(robot_file(options.robot));
  const std::filesystem::path out = options.out.empty() ? jumps_file(robot.name) : options.out;
  const Stopwatch watch(TimeOf::thread);
  const planner::JumpLibrary library =
      planner::compile_library(config.planner, robot, config.stand_posture, {}, show_progress);
  const double solve_s = 1e-3 * watch.milliseconds();
  const std::string bytes = library.bytes();
  if (out.has_parent_path()) std::filesystem::create_directories(out.parent_path());
  write_file_atomically(out, bytes);
  if (options.json) {
    const nlohmann::ordered_json json{
        {"schema", "hopscotch.library/1"}, {"robot", robot.name}, {"jumps", library.jumps().size()},
        {"size_bytes", bytes.size()},      {"solve_s", solve_s},  {"file", out.string()}};
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    std::printf("%s: %zu jumps of %s, %.1f MB, solved in %.0f s\n", out.c_str(),
                library.jumps().size(), robot.name.c_str(),
                1e-6 * static_cast<double>(bytes.size()), solve_s);
  }
  return library.jumps().empty() ? ExitStatus::answer_is_no : ExitStatus::ok;
}

}  // namespace

void add_library_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("library", "Compile a robot's library of solved jumps");
  command->footer(
      "The planner starts from these jumps what it cannot solve otherwise, and falls back on "
      "them.\n"
      "Nine minutes. Example: hopscotch library --robot hector");
  const auto options = std::make_shared<LibraryOptions>();  // shared with the action below
  command->add_option("--robot", options->robot, "Robot file")->capture_default_str();
  command->add_option("--config", options->config, "Tuning")->capture_default_str();
  command->add_option("--out", options->out, "File to write; default: where the program looks");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([&action, options] { action = [options] { return compile(*options); }; });
}

}  // namespace hopscotch::apps
