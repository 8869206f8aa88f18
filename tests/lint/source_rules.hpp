#pragma once

#include <string>
#include <vector>

#include "tests/lint/source_text.hpp"

namespace hopscotch::lint {

/// A place that breaks a house rule.
struct Violation {
  std::string path;
  int line = 0;
  std::string rule;
};

/// Checks C++ files of the tree against the rules of
/// `docs/decisions/0001-layout-and-house-rules.md` that can be seen in the text: which folder may
/// include which, where each external library lives, that no library shows in a header that another
/// folder includes, sizes of files, functions and parameter lists, and what library code must not
/// call.
[[nodiscard]] std::vector<Violation> check_sources(const std::vector<SourceFile>& files);

}  // namespace hopscotch::lint
