#include "msgs/live_link.hpp"

#include <lcm/lcm-cpp.hpp>
#include <utility>

#include "msgs/dispatcher.hpp"

namespace hopscotch::msgs {

namespace {
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;  // LCM counts microseconds
}

struct LiveLink::Connection {
  Connection(const std::string& url, RunLogHandlers handlers)
      : lcm(url), dispatcher(std::move(handlers)) {
    if (!lcm.good()) {
      throw LiveUnavailable("no live channels at " + url +
                            ": the address is wrong or there is no multicast route "
                            "(ip route add 224.0.0.0/4 dev lo)");
    }
    for (const std::string_view channel : dispatcher.channels()) {
      lcm.subscribe(std::string(channel), &Connection::take, this);
    }
  }

  void take(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    dispatcher.take({buffer->recv_utime * kNanosecondsPerMicrosecond}, channel,
                    {static_cast<const std::uint8_t*>(buffer->data),
                     static_cast<std::size_t>(buffer->data_size)});
  }

  lcm::LCM lcm;
  Dispatcher dispatcher;
};

LiveLink::LiveLink(const std::string& url, RunLogHandlers handlers)
    : connection_(std::make_unique<Connection>(url, std::move(handlers))) {}
LiveLink::~LiveLink() = default;

bool LiveLink::publish(std::string_view channel, std::span<const std::uint8_t> bytes) {
  return connection_->lcm.publish(std::string(channel), bytes.data(),
                                  static_cast<unsigned int>(bytes.size())) == 0;
}

bool LiveLink::receive(int timeout_ms) {
  return connection_->lcm.handleTimeout(timeout_ms) > 0;
}

const RunLogSummary& LiveLink::received() const {
  return connection_->dispatcher.summary();
}

}  // namespace hopscotch::msgs
