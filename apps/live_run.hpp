#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
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
 private:
  struct Told {
    core::Stamp now;
    std::variant<msgs::Event, msgs::Status, msgs::Ack> what;
  };

 public:
  /// @param box Gets every well-formed command that arrives; outlives this object.
  /// @param run_id Sender of what is told.
  /// @throws msgs::LiveUnavailable when the machine cannot carry live messages.
  LiveRun(const std::string& url, CommandBox& box, std::uint64_t run_id);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Neither waits for the network; one thread.
  void publish(const msgs::Event& event);
  /// A status or an answer, encoded and numbered on a thread of LiveRun's own: a status takes
  /// nothing from the heap of whoever tells it. The last status is said again, by the wall clock,
  /// while nothing else is: in lock-step time the loop can be silent for seconds while a jump is
  /// planned, and whoever waits for an answer must not think it gone.
  void tell(core::Stamp now, const msgs::Status& status);
  void tell(core::Stamp now, msgs::Ack answer);
  [[nodiscard]] Outbox<Told>::Counts counts() const { return outbox_.counts(); }

 private:
  bool deliver(const Told& told);

  msgs::EventMaker maker_;  ///< Of what is told; used by the outbox's thread only ...
  std::optional<msgs::Event> last_status_;  ///< ... and so is this.
  msgs::LiveLink commands_;
  msgs::LiveLink events_;  ///< Apart, so that a burst of events cannot crowd out a command.
  Outbox<Told> outbox_;
  std::atomic<bool> closing_{false};
  std::thread receiver_;
};

}  // namespace hopscotch::apps
