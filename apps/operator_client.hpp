#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/operator_command.hpp"
#include "msgs/live_link.hpp"

namespace hopscotch::apps {

/// A run that tells its status.
struct RunOnAir {
  std::uint64_t id = 0;
  std::uint64_t sequence = 0;  ///< Of its last status.
  bool is_alone = true;  ///< No other run has the same id: it would do what this one is asked.
};

/// Notes that a status with this tag was heard: of a sender numbers only grow.
void note_status(const msgs::Tag& tag, std::vector<RunOnAir>& runs);

/// The operator's end of the line: finds the running program and asks it.
class OperatorClient {
 public:
  /// @throws msgs::LiveUnavailable when the machine cannot carry live messages.
  explicit OperatorClient(const std::string& url);

  /// Runs that tell their status, each once; returns soon after the first one is heard, at the
  /// latest after `patience` [s].
  [[nodiscard]] std::vector<RunOnAir> running(double patience);

  /// Sends a command (run id and sequence filled in) and waits for the answer of that run.
  /// @param patience Without an answer [s]; a run that falls silent ends the wait early.
  [[nodiscard]] std::optional<msgs::Ack> ask(const core::OperatorCommand& command, double patience);

 private:
  std::vector<msgs::Tag> heard_;
  std::vector<msgs::Tagged<msgs::Ack>> answers_;
  msgs::LiveLink link_;
};

}  // namespace hopscotch::apps
