#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/command_gate.hpp"
#include "apps/outbox.hpp"
#include "core/operator_command.hpp"
#include "msgs/event.hpp"
#include "msgs/live_link.hpp"

namespace hopscotch::apps {

/// Commands on their way from other threads to the loop of a run. Bounded; any thread.
class CommandBox {
 public:
  /// @return false when too many wait: the command is lost.
  bool put(const core::OperatorCommand& command);
  [[nodiscard]] std::vector<core::OperatorCommand> take_all();

 private:
  static constexpr std::size_t kMost = 64;
  std::mutex mutex_;
  std::vector<core::OperatorCommand> waiting_;
};

/// LCM's environment variable LCM_DEFAULT_URL where it is set, else an address that stays on this
/// machine.
[[nodiscard]] std::string live_url();

/// The message that asks for a landing target or mode, by what the command says.
[[nodiscard]] core::OperatorCommand operator_command(
    const msgs::Tagged<msgs::TargetCommand>& message);
[[nodiscard]] core::OperatorCommand operator_command(
    const msgs::Tagged<msgs::ModeCommand>& message);
/// The answer as it travels; `now` is the tick that answered.
[[nodiscard]] msgs::Ack ack_of(core::Stamp now, const core::OperatorAnswer& answer);

/// A run on the network of this machine: publishes its events and receives commands.
class LiveRun {
 public:
  /// @param box Gets every well-formed command that arrives; outlives this object.
  /// @throws msgs::LiveUnavailable when the machine cannot carry live messages.
  LiveRun(const std::string& url, CommandBox& box);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Never waits for the network.
  void publish(const msgs::Event& event) { outbox_.put(event, event.bytes.size()); }
  [[nodiscard]] Outbox<msgs::Event>::Counts counts() const { return outbox_.counts(); }

 private:
  msgs::LiveLink commands_;
  msgs::LiveLink events_;  ///< Apart, so that a burst of events cannot crowd out a command.
  Outbox<msgs::Event> outbox_;
  std::atomic<bool> closing_{false};
  std::thread receiver_;
};

}  // namespace hopscotch::apps
