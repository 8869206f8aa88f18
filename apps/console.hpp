#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>

#include "apps/outbox.hpp"

namespace hopscotch::apps {

/// Lines for people, written by a thread of its own: a terminal that scrolls slowly or is stopped
/// must not make the robot miss an exchange. A line that it does not take within half a second is
/// lost. Saying something takes nothing from the heap and no lock; one thread at a time.
class Console {
 private:
  static constexpr std::size_t kLine = 1024;  // [byte]
  struct Line {
    std::array<char, kLine> text{};
    std::size_t size = 0;
    /// Makes the words of what stands in `text`; null: it is the words.
    std::string (*words)(const Line& line) = nullptr;
  };

 public:
  /// @param descriptor Open for writing; outlives this object.
  explicit Console(int descriptor);

  /// A line, its end is added; format as for std::printf.
  [[gnu::format(printf, 2, 3)]] void say(const char* format, ...);
  /// Lines whose words `kWords(facts)` makes on the thread that writes them, free to take memory
  /// for it. What the facts point to outlives this object.
  template <auto kWords, typename Facts>
  void tell(const Facts& facts) noexcept {
    static_assert(std::is_trivially_copyable_v<Facts> && sizeof(Facts) <= kLine);
    Line line;
    std::memcpy(line.text.data(), &facts, sizeof facts);
    line.size = sizeof facts;
    line.words = [](const Line& told) {
      Facts values;
      std::memcpy(&values, told.text.data(), sizeof values);
      return kWords(values);
    };
    outbox_.put(line, line.size);
  }
  [[nodiscard]] Outbox<Line>::Counts counts() const { return outbox_.counts(); }

 private:
  Outbox<Line> outbox_;
};

}  // namespace hopscotch::apps
