#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>

#include "msgs/event.hpp"
#include "msgs/live_link.hpp"

namespace hopscotch::apps {

/// Sends events over the network from a thread of its own. The queue in front of it is bounded:
/// when the network cannot keep up, events are dropped and counted, and whoever hands them over
/// never waits for it.
class LivePublisher {
 public:
  struct Counts {
    std::uint64_t sent = 0;
    std::uint64_t dropped = 0;  ///< Queue full.
    std::uint64_t failed = 0;   ///< Refused by the network.
  };
  static constexpr std::size_t kQueueBytes = 8U << 20U;

  /// @param link Outlives this object.
  explicit LivePublisher(msgs::LiveLink& link, std::size_t queue_bytes = kQueueBytes);
  /// Sends what is queued, for at most half a second.
  ~LivePublisher();
  LivePublisher(const LivePublisher&) = delete;
  LivePublisher& operator=(const LivePublisher&) = delete;

  void publish(msgs::Event event);
  [[nodiscard]] Counts counts() const;

 private:
  void work();

  msgs::LiveLink& link_;
  std::size_t queue_bytes_;
  mutable std::mutex mutex_;  ///< Held for the time of a push or pop only.
  std::condition_variable filled_;
  std::deque<msgs::Event> queue_;
  std::size_t queued_bytes_ = 0;
  bool closing_ = false;
  Counts counts_;
  std::thread thread_;
};

}  // namespace hopscotch::apps
