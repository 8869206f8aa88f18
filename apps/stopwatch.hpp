#pragma once

#include <ctime>

namespace hopscotch::apps {

/// Which time a Stopwatch reads.
enum class TimeOf : clockid_t {
  wall = CLOCK_MONOTONIC,  ///< What a user waits for.
  thread =
      CLOCK_THREAD_CPUTIME_ID  ///< Processor time of this thread; what other loads leave alone.
};

/// Time since its construction.
class Stopwatch {
 public:
  explicit Stopwatch(TimeOf time_of = TimeOf::wall)
      : clock_(static_cast<clockid_t>(time_of)), start_ms_(read_ms()) {}

  [[nodiscard]] double milliseconds() const { return read_ms() - start_ms_; }

 private:
  [[nodiscard]] double read_ms() const {
    timespec now{};
    clock_gettime(clock_, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }

  clockid_t clock_;
  double start_ms_;
};

}  // namespace hopscotch::apps
