#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "apps/commands.hpp"
#include "apps/explain.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

struct ExplainOptions {
  std::filesystem::path folder;
  bool json = false;
};

/// A broken file is bad input, not a machine that lacks something.
Explanation read_and_explain(const RunFolder& folder) try {
  return explain_run(folder);
} catch (const std::runtime_error& error) {
  throw core::ConfigError(error.what());
}

ExitStatus explain(const ExplainOptions& options) {
  const RunFolder folder{options.folder};
  for (const std::filesystem::path& file : {folder.result(), folder.log(), folder.robot()}) {
    if (!std::filesystem::is_regular_file(file)) {
      throw core::ConfigError(options.folder.string() +
                              ": is no run folder: " + file.filename().string() + " is missing");
    }
  }
  const Explanation explanation = read_and_explain(folder);
  std::fputs(to_text(explanation).c_str(), options.json ? stderr : stdout);
  if (options.json) std::fputs(to_json(explanation).c_str(), stdout);
  return explanation.first.cause == Cause::unknown ? ExitStatus::answer_is_no : ExitStatus::ok;
}

}  // namespace

void add_explain_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "explain", "The first cause of a fall, fault or refusal, with numbers and time");
  command->footer(
      "Exit status 0: explained, or nothing to explain; 1: the log does not tell.\n"
      "Example: hopscotch explain runs/stones-1");
  const auto options = std::make_shared<ExplainOptions>();  // shared with the action below
  command->add_option("RUN_DIR", options->folder, "Run folder")->required();
  command->add_flag("--json", options->json, "Print one JSON object on standard output");
  command->callback([&action, options] { action = [options] { return explain(*options); }; });
}

}  // namespace hopscotch::apps
