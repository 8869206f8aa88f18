#pragma once

#include <array>
#include <cstddef>

#include "apps/outbox.hpp"

namespace hopscotch::apps {

/// Lines for people, written by a thread of its own: a terminal that scrolls slowly or is stopped
/// must not make the robot miss an exchange. A line that it does not take within half a second is
/// lost. Saying
/// something takes nothing from the heap and no lock; one thread at a time.
class Console {
 private:
  struct Line {
    std::array<char, 1024> text{};
    std::size_t size = 0;
  };

 public:
  /// @param descriptor Open for writing; outlives this object.
  explicit Console(int descriptor);

  /// A line, its end is added; format as for std::printf.
  [[gnu::format(printf, 2, 3)]] void say(const char* format, ...);
  [[nodiscard]] Outbox<Line>::Counts counts() const { return outbox_.counts(); }

 private:
  Outbox<Line> outbox_;
};

}  // namespace hopscotch::apps
