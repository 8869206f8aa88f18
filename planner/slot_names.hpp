#pragma once

#include <string_view>

#include "planner/chain_layout.hpp"

namespace hopscotch::planner {

/// What an inequality of the chain problem limits, in the words of the certificate, e.g. "knee
/// torque-speed line". @param slot As ChainLayout counts.
[[nodiscard]] std::string_view slot_name(const ChainLayout& layout, int slot);

}  // namespace hopscotch::planner
