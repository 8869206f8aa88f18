#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "core/time.hpp"

namespace hopscotch::apps {

/// Holds results back until their declared latency has passed, so that lock-step runs pay for
/// compute time exactly as a robot would. First in, first out.
template <typename T>
class Delayed {
 public:
  void push(T value, core::Stamp ready) { waiting_.emplace_back(ready, std::move(value)); }

  /// The next value that is ready by `now`.
  std::optional<T> pop(core::Stamp now) {
    if (waiting_.empty() || waiting_.front().first > now) return std::nullopt;
    std::optional<T> value(std::move(waiting_.front().second));
    waiting_.pop_front();
    return value;
  }

  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  void clear() { waiting_.clear(); }

 private:
  std::deque<std::pair<core::Stamp, T>> waiting_;
};

}  // namespace hopscotch::apps
