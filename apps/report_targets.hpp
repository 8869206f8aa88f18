#pragma once

#include <string>

#include "apps/report_data.hpp"

namespace hopscotch::apps {

/// What the robot saw ahead of each jump, where it could have landed, what it chose and why not
/// elsewhere. A last refusal comes last.
[[nodiscard]] std::string draw_target_choices(const RunRecord& run);

}  // namespace hopscotch::apps
