#pragma once

#include <string>

#include "core/config_reader.hpp"
#include "core/time.hpp"

namespace hopscotch::apps {

/// How one thread is scheduled.
struct ThreadSetup {
  int priority = 0;  ///< Of SCHED_FIFO, 1 to 99; 0: ordinary.
  int cpu = -1;      ///< The only one it runs on; -1: any.

  static ThreadSetup load(const core::ConfigReader& section);
};

/// Section `threads`: of `robot` by the clock and of `run --threads`.
struct ThreadsConfig {
  ThreadSetup control;     ///< Exchanges, estimator, phase machine, torque law.
  ThreadSetup mpc;         ///< Wrenches for the next milliseconds.
  ThreadSetup planning;    ///< Where the next jump lands, and how.
  ThreadSetup perception;  ///< Depth frames into the map.

  static ThreadsConfig load(const core::ConfigReader& section);
};

/// Gives the calling thread its priority and CPU. @return What this machine refuses, with the fix;
/// empty when all is well.
[[nodiscard]] std::string schedule_this_thread(const ThreadSetup& setup);

/// Keeps all memory of the process in place, now and later. @return as above.
[[nodiscard]] std::string lock_memory();

/// Touches the stack of the calling thread once, so that no page of it is missing later.
void touch_stack();

/// The monotonic clock, a second of which takes `slowdown` seconds.
[[nodiscard]] core::Stamp slowed_clock(double slowdown);

/// The moments k * period from the start on, by that clock.
class PeriodicWake {
 public:
  /// @param period   On the clock that wait() tells [s].
  /// @param slowdown A second of that clock takes so many of the machine's.
  explicit PeriodicWake(double period, double slowdown = 1.0);

  /// Sleeps until the next moment that has not passed yet. @return Now. One that has passed is not
  /// made up for: a burst of late exchanges would be worse than a missing one.
  core::Stamp wait() noexcept;

 private:
  double slowdown_;
  std::int64_t period_;  // of the machine's clock [ns]
  std::int64_t next_;    // [ns]
};

}  // namespace hopscotch::apps
