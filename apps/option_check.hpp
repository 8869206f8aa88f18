#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>

namespace hopscotch::apps {

/// For numbers on the command line, instead of CLI::Range: that one lets NaN through.
/// An option passes if it is a finite number with lowest <= x <= highest.
[[nodiscard]] CLI::Validator finite_number(
    double lowest = -std::numeric_limits<double>::infinity(),
    double highest = std::numeric_limits<double>::infinity());

/// For counts, seeds and ports: decimal digits alone. CLI11 itself takes -1 for 2^64 - 1, 2^64 for
/// the same, and 010 for eight.
[[nodiscard]] CLI::Validator whole_number(
    std::uint64_t lowest = 0, std::uint64_t highest = std::numeric_limits<std::uint64_t>::max());

}  // namespace hopscotch::apps
