#include "apps/live_publisher.hpp"

#include <chrono>
#include <utility>

namespace hopscotch::apps {

LivePublisher::LivePublisher(msgs::LiveLink& link, std::size_t queue_bytes)
    : link_(link), queue_bytes_(queue_bytes), thread_([this] { work(); }) {}

LivePublisher::~LivePublisher() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  filled_.notify_one();
  thread_.join();
}

void LivePublisher::publish(msgs::Event event) {
  {
    const std::lock_guard lock(mutex_);
    if (queued_bytes_ + event.bytes.size() > queue_bytes_) {
      ++counts_.dropped;
      return;
    }
    queued_bytes_ += event.bytes.size();
    queue_.push_back(std::move(event));
  }
  filled_.notify_one();
}

LivePublisher::Counts LivePublisher::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void LivePublisher::work() {
  constexpr auto kFarewell = std::chrono::milliseconds(500);
  std::chrono::steady_clock::time_point last_call = std::chrono::steady_clock::time_point::max();
  std::unique_lock lock(mutex_);
  while (true) {
    filled_.wait(lock, [this] { return closing_ || !queue_.empty(); });
    if (closing_ && last_call == std::chrono::steady_clock::time_point::max()) {
      last_call = std::chrono::steady_clock::now() + kFarewell;
    }
    if (queue_.empty() || std::chrono::steady_clock::now() > last_call) return;
    const msgs::Event event = std::move(queue_.front());
    queue_.pop_front();
    queued_bytes_ -= event.bytes.size();
    lock.unlock();
    const bool sent = link_.publish(event.channel, event.bytes);
    lock.lock();
    ++(sent ? counts_.sent : counts_.failed);
  }
}

}  // namespace hopscotch::apps
