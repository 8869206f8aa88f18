#include "apps/pacer.hpp"

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

namespace hopscotch::apps {

namespace {

constexpr double kTick = 0.001;  // simulated [s]

}  // namespace

Pacer::Pacer(double pace, const ThreadSetup& thread) : pace_(pace), period_(kTick / pace) {
  for (const std::string& refused : {lock_memory(), schedule_this_thread(thread)}) {
    if (!refused.empty()) std::fprintf(stderr, "hopscotch: warning: %s\n", refused.c_str());
  }
  touch_stack();
  wake_.emplace(period_);
}

void Pacer::wait(core::Stamp now) {
  if (wake_) {
    const core::Stamp woken = wake_->wait();
    if (woken_ && woken.since(*woken_) > 1.5 * period_) ++missed_;
    woken_ = woken;
  } else if (pace_ > 0.0) {
    const double ahead_ms = 1e3 * now.seconds() / pace_ - watch_.milliseconds();
    if (ahead_ms > 1.0) {
      std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ahead_ms));
    }
  }
}

}  // namespace hopscotch::apps
