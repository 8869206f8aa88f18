#pragma once

#include <string>

#include "apps/report_data.hpp"

namespace hopscotch::apps {

/// The whole crossing from the side, to scale: terrain as it is and as it was seen, path of the
/// centre of mass as planned and as flown, targets, footprints. The page's script moves a figure
/// through it.
[[nodiscard]] std::string draw_crossing(const RunRecord& run);

/// One jump from the side, to scale, with the robot at its key instants.
[[nodiscard]] std::string draw_jump(const RunRecord& run, const JumpRecord& jump);

/// Numbers of the moving figure for the page's script, as a JSON object.
[[nodiscard]] std::string replay_data(const RunRecord& run);

}  // namespace hopscotch::apps
