#pragma once

#include <string>

#include "apps/run_result.hpp"

namespace hopscotch::apps {

/// The result in one sentence, plain text.
[[nodiscard]] std::string headline(const RunResult& result);

/// The same figures as a row of tiles.
[[nodiscard]] std::string draw_tiles(const RunResult& result);

/// One line per jump.
[[nodiscard]] std::string draw_jump_table(const RunResult& result);

}  // namespace hopscotch::apps
