#pragma once

#include "apps/commands.hpp"

namespace hopscotch::apps {

/// `hopscotch library`.
void add_library_command(CLI::App& app, Action& action);

}  // namespace hopscotch::apps
