#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/commands.hpp"
#include "apps/explain.hpp"

namespace hopscotch::apps {

namespace {

struct ExplainOptions {
  std::filesystem::path folder;
  bool json = false;
};

ExitStatus explain(const ExplainOptions& options) {
  const RunFolder folder{options.folder};
  require_run_folder(folder);
  const Explanation explanation = explain_run(folder);
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
