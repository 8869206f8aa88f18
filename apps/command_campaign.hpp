#pragma once

#include "apps/commands.hpp"

namespace hopscotch::apps {

/// Many seeded runs: `hopscotch campaign`.
void add_campaign_command(CLI::App& app, Action& action);

}  // namespace hopscotch::apps
