#pragma once

#include <string>

#include "apps/report_data.hpp"

namespace hopscotch::apps {

/// Torque, speed and power of the pitch joints' motors over time, against their limits.
[[nodiscard]] std::string draw_motor_charts(const RunRecord& run);

/// Every operating point of those motors in the torque-speed plane, with the envelope of eq. (9d).
[[nodiscard]] std::string draw_motor_envelopes(const RunRecord& run);

}  // namespace hopscotch::apps
