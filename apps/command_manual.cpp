#include <cstdio>
#include <memory>
#include <string>

#include "apps/commands.hpp"
#include "apps/installation.hpp"
#include "apps/manual.hpp"

namespace hopscotch::apps {

void add_manual_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("manual", "Prints the man page or the shell completion");
  command->footer(
      "Example: hopscotch manual man | man -l -\n"
      "         source <(hopscotch manual bash)");
  const auto form = std::make_shared<std::string>("man");  // shared with the action below
  command->add_option("FORM", *form, "What to print")
      ->check(CLI::IsMember({"man", "bash"}))
      ->capture_default_str();
  command->callback([&app, &action, form] {
    action = [&app, form] {
      const std::string text =
          *form == "man" ? man_page(app, program_version()) : bash_completion(app);
      std::fputs(text.c_str(), stdout);
      return ExitStatus::ok;
    };
  });
}

}  // namespace hopscotch::apps
