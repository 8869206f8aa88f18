#pragma once

#include <string>

#include "apps/outbox.hpp"

namespace hopscotch::apps {

/// Lines for people, written by a thread of its own: a terminal that scrolls slowly or is stopped
/// must not make the robot miss an exchange. A line that it does not take within half a second is
/// lost.
class Console {
 public:
  /// @param descriptor Open for writing; outlives this object.
  explicit Console(int descriptor);

  /// A line, its end is added; format as for std::printf.
  [[gnu::format(printf, 2, 3)]] void say(const char* format, ...);
  [[nodiscard]] Outbox<std::string>::Counts counts() const { return outbox_.counts(); }

 private:
  Outbox<std::string> outbox_;
};

}  // namespace hopscotch::apps
