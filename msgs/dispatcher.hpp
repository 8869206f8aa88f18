#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "msgs/run_log.hpp"

namespace hopscotch::msgs {

/// Hands messages over to the handler of their channel, from a log or from the network.
class Dispatcher {
 public:
  explicit Dispatcher(RunLogHandlers handlers);
  Dispatcher(const Dispatcher&) = delete;  // entries refer to the handlers
  Dispatcher& operator=(const Dispatcher&) = delete;

  void take(core::Stamp written, std::string_view channel, std::span<const std::uint8_t> bytes);

  /// Channels that somebody listens to.
  [[nodiscard]] std::vector<std::string_view> channels() const;
  [[nodiscard]] const RunLogSummary& summary() const { return summary_; }

 private:
  template <typename Value>
  void on(std::string_view channel, const RunLogHandlers::Handler<Value>& handler);

  using Entry = std::function<void(core::Stamp, std::span<const std::uint8_t>)>;

  RunLogHandlers handlers_;
  RunLogSummary summary_;
  std::map<std::string_view, Entry> entries_;  ///< An empty entry: our channel, nobody listens.
};

}  // namespace hopscotch::msgs
