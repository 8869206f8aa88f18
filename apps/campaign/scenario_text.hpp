#pragma once

#include <string>

#include "sim/scenario.hpp"

namespace hopscotch::apps::campaign {

/// The scenario as a scenario file that reads back as the same scenario; ends of
/// slabs to a nanometre, all else number by number.
[[nodiscard]] std::string scenario_text(const sim::Scenario& scenario);

}  // namespace hopscotch::apps::campaign
