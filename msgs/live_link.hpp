#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "msgs/run_log.hpp"

namespace hopscotch::msgs {

/// This machine cannot carry live messages, e.g. for want of a multicast route.
class LiveUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The channels as they run on the network. With the default address nothing leaves the machine.
class LiveLink {
 public:
  /// @param url      Of LCM, e.g. `kDefaultUrl`; "memq://" stays within this object.
  /// @param handlers Called by `receive`; only channels that have one are listened to.
  /// @throws LiveUnavailable naming the address.
  explicit LiveLink(const std::string& url, RunLogHandlers handlers = {});
  ~LiveLink();
  LiveLink(const LiveLink&) = delete;
  LiveLink& operator=(const LiveLink&) = delete;

  /// Any thread. @return false if the network refused the message.
  bool publish(std::string_view channel, std::span<const std::uint8_t> bytes);

  /// Waits for one message and hands it over; the time of writing that handlers see is the moment
  /// of arrival. One thread. @return false if none came within `timeout_ms`.
  bool receive(int timeout_ms);

  /// Of everything that came so far.
  [[nodiscard]] const RunLogSummary& received() const;

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace hopscotch::msgs
