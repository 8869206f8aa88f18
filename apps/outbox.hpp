#pragma once

#include <semaphore.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

namespace hopscotch::apps {

/// A bounded ring and a thread that delivers what is in it: whoever puts something in never waits
/// for a network or a terminal. What does not fit is dropped and counted. Putting is for one thread
/// at a time; it takes no lock and nothing from the heap beyond what the item brings along.
template <typename Item>
class Outbox {
 public:
  struct Counts {
    std::uint64_t sent = 0;
    std::uint64_t dropped = 0;  ///< Ring full.
    std::uint64_t failed = 0;   ///< Could not be delivered.
  };
  struct Limits {
    std::size_t bytes = 0;     ///< As told with the items.
    std::size_t items = 1024;  ///< Places, all made at the start.
  };
  /// What the thread does whenever nothing has come for a while.
  struct Idle {
    std::chrono::milliseconds after{0};  ///< 0: nothing.
    std::function<void()> act;
  };

  /// @param deliver Called on the thread of its own, in order; false: could not be delivered.
  Outbox(std::function<bool(const Item&)> deliver, Limits limits, Idle idle = {})
      : deliver_(std::move(deliver)),
        idle_(std::move(idle)),
        bytes_max_(limits.bytes),
        places_(limits.items) {
    sem_init(&filled_, 0, 0);
    thread_ = std::thread([this] { work(); });
  }
  /// Delivers what is queued, for at most half a second.
  ~Outbox() {
    closing_ = true;
    sem_post(&filled_);
    thread_.join();
    sem_destroy(&filled_);
  }
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void put(Item item, std::size_t bytes) noexcept {
    const std::size_t at = put_.load(std::memory_order_relaxed);
    const bool full = at - taken_.load(std::memory_order_acquire) >= places_.size() ||
                      bytes_.load(std::memory_order_relaxed) + bytes > bytes_max_;
    if (full) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    bytes_.fetch_add(bytes, std::memory_order_relaxed);
    places_[at % places_.size()] = {std::move(item), bytes};
    put_.store(at + 1, std::memory_order_release);
    sem_post(&filled_);
  }
  [[nodiscard]] Counts counts() const { return {sent_, dropped_, failed_}; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Place {
    Item item{};
    std::size_t bytes = 0;
  };

  void work() {
    constexpr auto kFarewell = std::chrono::milliseconds(500);
    Clock::time_point last_call = Clock::time_point::max();
    while (true) {
      const bool woken = wait();
      if (closing_ && last_call == Clock::time_point::max()) last_call = Clock::now() + kFarewell;
      const std::size_t at = taken_.load(std::memory_order_relaxed);
      const bool empty = at == put_.load(std::memory_order_acquire);
      if (Clock::now() > last_call || (empty && closing_)) return;
      if (!empty) {
        deliver_next(at);
      } else if (!woken) {
        idle_.act();
      }
    }
  }

  /// @return false: nothing came within the time of idling.
  bool wait() {
    while (true) {
      int result = 0;
      if (idle_.after.count() > 0) {
        constexpr std::int64_t kSecond = 1'000'000'000;
        timespec until{};
        clock_gettime(CLOCK_MONOTONIC, &until);
        const std::int64_t end = until.tv_nsec + std::chrono::nanoseconds(idle_.after).count();
        until = {.tv_sec = until.tv_sec + end / kSecond, .tv_nsec = end % kSecond};
        result = sem_clockwait(&filled_, CLOCK_MONOTONIC, &until);
      } else {
        result = sem_wait(&filled_);
      }
      if (result == 0) return true;
      if (errno == ETIMEDOUT) return false;
    }
  }

  void deliver_next(std::size_t at) {
    const Place next = std::move(places_[at % places_.size()]);
    bytes_.fetch_sub(next.bytes, std::memory_order_relaxed);
    taken_.store(at + 1, std::memory_order_release);
    ++(deliver_(next.item) ? sent_ : failed_);
  }

  std::function<bool(const Item&)> deliver_;
  Idle idle_;
  std::size_t bytes_max_;
  std::vector<Place> places_;
  sem_t filled_{};                     // one for each item, one for closing
  std::atomic<std::size_t> put_{0};    // so far; only the putting thread changes it
  std::atomic<std::size_t> taken_{0};  // so far; only the delivering thread changes it
  std::atomic<std::size_t> bytes_{0};  // in the ring
  std::atomic<std::uint64_t> sent_{0};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::uint64_t> failed_{0};
  std::atomic<bool> closing_{false};
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace hopscotch::apps
