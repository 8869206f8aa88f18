#pragma once

#include <string>
#include <vector>

namespace hopscotch::apps::campaign {

/// What a program that was called said.
struct CommandAnswer {
  int status = -1;  ///< Exit status; -1: no such program, killed, or out of time.
  bool timed_out = false;
  std::string output;  ///< Standard output and standard error.
};

/// Calls a program and waits at most so long [s], then kills it: clients of a cluster block for
/// ever when its controller is gone.
[[nodiscard]] CommandAnswer call(const std::vector<std::string>& words, double timeout);

}  // namespace hopscotch::apps::campaign
