#pragma once

#include <vector>

#include "apps/finding.hpp"

namespace hopscotch::apps {

/// The libraries that the program runs with, each with its file and, where dpkg knows it, the
/// version of its package: what differs between two machines that compute differently.
[[nodiscard]] std::vector<Finding> check_packages();

}  // namespace hopscotch::apps
