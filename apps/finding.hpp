#pragma once

#include <string>

namespace hopscotch::apps {

/// One thing that this machine can or cannot do.
struct Finding {
  std::string name;
  bool ok = false;
  std::string found = "";
  std::string fix = "";  ///< Command or action; empty when all is well.
  std::string needed_for = "";
};

}  // namespace hopscotch::apps
