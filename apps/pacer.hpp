#pragma once

#include <cstdint>
#include <optional>

#include "apps/real_time.hpp"
#include "apps/stopwatch.hpp"
#include "core/time.hpp"

namespace hopscotch::apps {

/// Keeps simulated time from running ahead of the wall clock.
class Pacer {
 public:
  /// About right, for who watches. @param pace Times real time; 0: as fast as it goes.
  explicit Pacer(double pace) : pace_(pace) {}
  /// Tick for tick, at the priority of a robot's control thread; what the machine refuses of that
  /// is said on standard error.
  Pacer(double pace, const ThreadSetup& thread);

  /// After each tick. @param now Simulated time.
  void wait(core::Stamp now);

  /// Ticks that began more than half a period late.
  [[nodiscard]] std::uint64_t missed() const { return missed_; }
  /// Since the start, by the wall clock.
  [[nodiscard]] double elapsed_ms() const { return watch_.milliseconds(); }

 private:
  double pace_;
  Stopwatch watch_;
  double period_ = 0.0;  // of ticks by the wall clock [s]
  std::optional<PeriodicWake> wake_;
  std::optional<core::Stamp> woken_;
  std::uint64_t missed_ = 0;
};

}  // namespace hopscotch::apps
