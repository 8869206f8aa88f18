#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace hopscotch::apps {

/// A bounded queue and a thread that delivers what is in it: whoever puts something in never waits
/// for a network or a terminal. What does not fit is dropped and counted.
template <typename Item>
class Outbox {
 public:
  struct Counts {
    std::uint64_t sent = 0;
    std::uint64_t dropped = 0;  ///< Queue full.
    std::uint64_t failed = 0;   ///< Could not be delivered.
  };

  /// @param deliver Called on the thread of its own, in order; false: could not be delivered.
  Outbox(std::function<bool(const Item&)> deliver, std::size_t bytes_max)
      : deliver_(std::move(deliver)), bytes_max_(bytes_max), thread_([this] { work(); }) {}
  /// Delivers what is queued, for at most half a second.
  ~Outbox() {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
    }
    filled_.notify_one();
    thread_.join();
  }
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void put(Item item, std::size_t bytes) {
    {
      const std::lock_guard lock(mutex_);
      if (bytes_ + bytes > bytes_max_) {
        ++counts_.dropped;
        return;
      }
      bytes_ += bytes;
      queue_.push_back({std::move(item), bytes});
    }
    filled_.notify_one();
  }
  [[nodiscard]] Counts counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  struct Queued {
    Item item;
    std::size_t bytes = 0;
  };

  void work() {
    using Clock = std::chrono::steady_clock;
    constexpr auto kFarewell = std::chrono::milliseconds(500);
    Clock::time_point last_call = Clock::time_point::max();
    std::unique_lock lock(mutex_);
    while (true) {
      filled_.wait(lock, [this] { return closing_ || !queue_.empty(); });
      if (closing_ && last_call == Clock::time_point::max()) last_call = Clock::now() + kFarewell;
      if (queue_.empty() || Clock::now() > last_call) return;
      const Queued next = std::move(queue_.front());
      queue_.pop_front();
      bytes_ -= next.bytes;
      lock.unlock();
      const bool sent = deliver_(next.item);
      lock.lock();
      ++(sent ? counts_.sent : counts_.failed);
    }
  }

  std::function<bool(const Item&)> deliver_;
  std::size_t bytes_max_;
  mutable std::mutex mutex_;  ///< Held for the time of a push or pop only.
  std::condition_variable filled_;
  std::deque<Queued> queue_;
  std::size_t bytes_ = 0;
  bool closing_ = false;
  Counts counts_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace hopscotch::apps
