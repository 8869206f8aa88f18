#pragma once

#include <string>

#include "apps/commands.hpp"
#include "core/operator_command.hpp"

namespace hopscotch::apps {

/// Options that `hopscotch target` and `hopscotch command` share.
struct AskOptions {
  std::string run;         ///< Id of the run; empty: the only one that is on.
  double patience = 15.0;  ///< For the answer [s].
  bool json = false;
};

void add_ask_options(CLI::App& command, AskOptions& options);

/// Finds the run, asks it and says what it answered.
/// @throws core::ConfigError on a run id that is none; msgs::LiveUnavailable.
[[nodiscard]] ExitStatus ask_run(const AskOptions& options, core::OperatorCommand command);

}  // namespace hopscotch::apps
