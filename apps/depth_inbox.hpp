#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "core/depth_source.hpp"
#include "msgs/live_link.hpp"

namespace hopscotch::apps {

/// A depth camera somewhere else on this machine: the frames of HOP_DEPTH. Whoever sends them says
/// where the camera sits on the trunk, and stamps mid exposure by the clock of the program that
/// listens: CLOCK_MONOTONIC, or the world's time in lock-step. Frames are decoded on a thread of
/// their own; when they come faster than they are taken, the oldest are lost and counted.
class DepthInbox final : public core::DepthSource {
 public:
  /// @throws msgs::LiveUnavailable when the machine cannot carry live messages.
  explicit DepthInbox(const std::string& url);
  ~DepthInbox() override;
  DepthInbox(const DepthInbox&) = delete;
  DepthInbox& operator=(const DepthInbox&) = delete;

  /// Waits for no more than the copying of a frame's place in the queue.
  std::optional<core::DepthFrame> poll(core::Stamp now) override;

  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  void put(core::DepthFrame frame);

  static constexpr std::size_t kMost = 4;
  std::mutex mutex_;
  std::deque<core::DepthFrame> waiting_;
  std::atomic<std::uint64_t> lost_{0};
  msgs::LiveLink link_;
  std::atomic<bool> closing_{false};
  std::thread receiver_;
};

}  // namespace hopscotch::apps
