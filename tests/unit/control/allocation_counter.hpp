#pragma once

#include <cstddef>

namespace hopscotch::control::testing {

/// Calls of operator new in this program so far; its translation unit replaces the operator.
std::size_t allocation_count();

}  // namespace hopscotch::control::testing
