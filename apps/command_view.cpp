#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "apps/commands.hpp"
#include "apps/option_check.hpp"
#include "apps/run_folder.hpp"
#include "apps/run_result.hpp"
#include "apps/text_file.hpp"
#include "apps/web_server.hpp"
#include "apps/web_story.hpp"
#include "msgs/run_log.hpp"

namespace hopscotch::apps {

namespace {

struct ViewOptions {
  std::filesystem::path folder;
  int port = kWebPort;
};

/// Blocks until Ctrl-C or a polite kill. @pre the two signals are blocked in all threads
void wait_for_goodbye(const sigset_t& goodbyes) {
  int signal = 0;
  sigwait(&goodbyes, &signal);
}

ExitStatus view(const ViewOptions& options) {
  const RunFolder folder{options.folder};
  require_run_folder(folder);
  const RunResult result = read_run_result(folder.result());
  WebStory story(model::RobotParameters::load(folder.robot()),
                 {.run_id = result.run_id,
                  .scenario = result.scenario,
                  .live = false,
                  .result = read_file(folder.result())});
  const msgs::RunLogSummary summary = msgs::read_run_log(folder.log(), story.handlers());
  if (summary.malformed > 0) {
    std::fprintf(stderr, "hopscotch: %zu messages of the log could not be read\n",
                 summary.malformed);
  }
  sigset_t goodbyes;
  sigemptyset(&goodbyes);
  sigaddset(&goodbyes, SIGINT);
  sigaddset(&goodbyes, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &goodbyes, nullptr);  // before the server's threads start
  const WebServer server(options.port, story, options.folder, {});
  std::printf("%s: %s\nCtrl-C ends it.\n", result.scenario.c_str(), server.url().c_str());
  std::fflush(stdout);
  wait_for_goodbye(goodbyes);
  return ExitStatus::ok;
}

}  // namespace

void add_view_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("view", "Serves the page of a finished run: 3-D, in a browser");
  command->footer(
      "Only browsers on this machine can open it.\nExample: hopscotch view runs/stones-1");
  const auto options = std::make_shared<ViewOptions>();  // shared with the action below
  command->add_option("RUN_DIR", options->folder, "Run folder")->required();
  command->add_option("--port", options->port, "Of the page; 0: any that is free")
      ->check(whole_number(0, 65535))
      ->capture_default_str();
  command->callback([&action, options] { action = [options] { return view(*options); }; });
}

}  // namespace hopscotch::apps
