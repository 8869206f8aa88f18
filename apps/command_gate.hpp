#pragma once

#include <cstdint>
#include <string>

#include "core/operator_command.hpp"
#include "core/reason.hpp"

namespace hopscotch::apps {

/// Microseconds since 1970 by this machine's clock: the sequence number of an operator's command.
[[nodiscard]] std::uint64_t wall_clock_us();

/// Lets commands in that are meant for this run, are fresh, and have not been in before. Sender and
/// run share one machine and so one clock; a command's sequence number is when it was made.
class CommandGate {
 public:
  /// @param opened_us Wall clock now: older commands are somebody's recording.
  CommandGate(std::uint64_t run_id, std::uint64_t opened_us)
      : run_id_(run_id), last_(opened_us), opened_(opened_us) {}

  /// Reason `none`: come in. Otherwise wrong_run, stale_command or repeated_command.
  core::Refusal check(const core::OperatorCommand& command, std::uint64_t now_us);

 private:
  std::uint64_t run_id_;
  std::uint64_t last_;  ///< Largest sequence number that came in.
  std::uint64_t opened_;
};

/// 16 hexadecimal digits, as in `result.json`.
[[nodiscard]] std::string run_id_text(std::uint64_t id);
/// @return false if the text is no such number.
[[nodiscard]] bool parse_run_id(const std::string& text, std::uint64_t& id);

}  // namespace hopscotch::apps
