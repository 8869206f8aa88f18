#include <array>
#include <memory>
#include <string>
#include <vector>

#include "apps/command_operator.hpp"

namespace hopscotch::apps {

namespace {

using core::ModeRequest;

constexpr std::array<ModeRequest, 6> kModes{ModeRequest::enable, ModeRequest::jump,
                                            ModeRequest::hold,   ModeRequest::stop,
                                            ModeRequest::damp,   ModeRequest::clear_fault};

std::vector<std::string> mode_names() {
  std::vector<std::string> names;
  for (const ModeRequest mode : kModes) names.emplace_back(core::mode_request_name(mode));
  return names;
}

struct ModeOptions {
  std::string mode;
  AskOptions ask;
};

ExitStatus command_mode(const ModeOptions& options) {
  core::OperatorCommand command;
  for (const ModeRequest mode : kModes) {
    if (options.mode == core::mode_request_name(mode)) command.mode = mode;
  }
  return ask_run(options.ask, command);
}

}  // namespace

void add_command_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("command", "Mode commands to a running program");
  command->footer(
      "enable       switch the drives on\n"
      "jump         jump on by itself, after hold\n"
      "hold         land the present jump, then stand\n"
      "stop         land the present jump, stand, end the run\n"
      "damp         brake all drives at once: the robot sinks down\n"
      "clear-fault  after a fault has been looked at\n"
      "Exit status 0: accepted, 1: refused or nobody answered.\n"
      "Example: hopscotch command hold");
  const auto options = std::make_shared<ModeOptions>();  // shared with the action below
  command->add_option("MODE", options->mode, "What the robot is to do")
      ->required()
      ->check(CLI::IsMember(mode_names()));
  add_ask_options(*command, options->ask);
  command->callback([&action, options] { action = [options] { return command_mode(*options); }; });
}

}  // namespace hopscotch::apps
