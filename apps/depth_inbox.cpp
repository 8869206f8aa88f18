#include "apps/depth_inbox.hpp"

#include <utility>

namespace hopscotch::apps {

DepthInbox::DepthInbox(const std::string& url)
    : link_(url, [this] {
        msgs::RunLogHandlers handlers;
        handlers.depth = [this](core::Stamp, const auto& message) { put(message.value.frame); };
        return handlers;
      }()) {
  receiver_ = std::thread([this] {
    constexpr int kPatience = 100;  // [ms], then look whether the program is over
    while (!closing_) link_.receive(kPatience);
  });
}

DepthInbox::~DepthInbox() {
  closing_ = true;
  receiver_.join();
}

void DepthInbox::put(core::DepthFrame frame) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(frame));
  if (waiting_.size() <= kMost) return;
  waiting_.pop_front();
  ++lost_;
}

std::optional<core::DepthFrame> DepthInbox::poll(core::Stamp now) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock() || waiting_.empty() || now < waiting_.front().stamp) return std::nullopt;
  core::DepthFrame frame = std::move(waiting_.front());
  waiting_.pop_front();
  return frame;
}

}  // namespace hopscotch::apps
