#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace hopscotch::core {

/// A moment on the robot's monotonic clock (simulated time in simulation). Integer nanoseconds, so
/// that a thousand 1 ms ticks are exactly one second and replays compare bit by bit.
struct Stamp {
  std::int64_t nanoseconds = 0;

  static Stamp from_seconds(double seconds) {
    return {static_cast<std::int64_t>(std::llround(seconds * 1e9))};
  }
  [[nodiscard]] double seconds() const { return static_cast<double>(nanoseconds) * 1e-9; }
  /// This moment shifted by `duration` [s].
  [[nodiscard]] Stamp after(double duration) const {
    return {nanoseconds + from_seconds(duration).nanoseconds};
  }
  /// Time that has passed since `earlier` [s].
  [[nodiscard]] double since(Stamp earlier) const {
    return static_cast<double>(nanoseconds - earlier.nanoseconds) * 1e-9;
  }
  auto operator<=>(const Stamp&) const = default;
};

}  // namespace hopscotch::core
