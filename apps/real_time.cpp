#include "apps/real_time.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <system_error>

namespace hopscotch::apps {

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

std::int64_t monotonic_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

std::string refusal(const std::string& what, int error, const std::string& fix) {
  return what + ": " + std::generic_category().message(error) + "; fix: " + fix;
}

}  // namespace

ThreadSetup ThreadSetup::load(const core::ConfigReader& section) {
  ThreadSetup setup;
  setup.priority = section.integer("priority", 0, 99);
  setup.cpu = section.integer("cpu", -1, 1023);
  section.finish();
  return setup;
}

ThreadsConfig ThreadsConfig::load(const core::ConfigReader& section) {
  ThreadsConfig config;
  config.control = ThreadSetup::load(section.section("control"));
  config.mpc = ThreadSetup::load(section.section("mpc"));
  config.planning = ThreadSetup::load(section.section("planning"));
  config.perception = ThreadSetup::load(section.section("perception"));
  section.finish();
  return config;
}

std::string schedule_this_thread(const ThreadSetup& setup) {
  if (setup.priority > 0) {
    const sched_param parameters{.sched_priority = setup.priority};
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    if (error != 0) {
      return refusal("real-time priority " + std::to_string(setup.priority), error,
                     "add '@realtime - rtprio 90' to /etc/security/limits.conf and log in again, "
                     "or run as root");
    }
  }
  if (setup.cpu >= 0) {
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    CPU_SET(static_cast<unsigned>(setup.cpu), &cpus);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof cpus, &cpus);
    if (error != 0) {
      return refusal("CPU " + std::to_string(setup.cpu), error,
                     "name a CPU that this machine has in `threads`");
    }
  }
  return "";
}

std::string lock_memory() {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return "";
  return refusal("locking memory", errno,
                 "add '@realtime - memlock unlimited' to /etc/security/limits.conf and log in "
                 "again, or run as root");
}

void touch_stack() {
  constexpr std::size_t kBytes = 256 * 1024;
  constexpr std::size_t kPage = 4096;
  std::array<volatile char, kBytes> stack;
  for (std::size_t i = 0; i < kBytes; i += kPage) stack[i] = 0;
}

core::Stamp slowed_clock(double slowdown) {
  return {std::llround(static_cast<double>(monotonic_now()) / slowdown)};
}

PeriodicWake::PeriodicWake(double period, double slowdown)
    : slowdown_(slowdown), period_(std::llround(1e9 * period * slowdown)), next_(monotonic_now()) {}

core::Stamp PeriodicWake::wait() noexcept {
  const std::int64_t now = monotonic_now();
  next_ += period_;
  if (next_ <= now) next_ += (now - next_) / period_ * period_ + period_;
  const timespec until{.tv_sec = next_ / kSecond, .tv_nsec = next_ % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  return slowed_clock(slowdown_);
}

}  // namespace hopscotch::apps
