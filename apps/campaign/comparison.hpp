#pragma once

#include <string>
#include <vector>

#include "apps/campaign/statistics.hpp"
#include "apps/campaign/store.hpp"

namespace hopscotch::apps::campaign {

/// Two campaigns on the same draws, trial by trial.
struct Comparison {
  std::string name_a;
  std::string name_b;
  std::string program_a;
  std::string program_b;
  PairedCounts total;
  std::vector<PairedCounts> cells;
  /// Trials that only one of the two succeeded in, the first ones.
  std::vector<std::int64_t> only_a;
  std::vector<std::int64_t> only_b;
};

/// Pairs the trials that both stores have.
/// @throws core::ConfigError if their draws differ, so that nothing pairs.
[[nodiscard]] Comparison compare(const Store& a, const Store& b);

/// `comparison.json`, schema "hopscotch.comparison/1".
[[nodiscard]] std::string comparison_json(const Comparison& comparison,
                                          const std::vector<Factor>& factors);

}  // namespace hopscotch::apps::campaign
