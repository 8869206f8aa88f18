#include "apps/command_gate.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>

namespace hopscotch::apps {

using core::Reason;

std::uint64_t wall_clock_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

core::Refusal CommandGate::check(const core::OperatorCommand& command, std::uint64_t now_us) {
  constexpr std::uint64_t kFresh = 5'000'000;  // [us]
  if (command.run_id != run_id_) {
    return {Reason::wrong_run, "it is meant for run " + run_id_text(command.run_id) +
                                   ", and this is run " + run_id_text(run_id_)};
  }
  if (command.sequence <= opened_ || now_us > command.sequence + kFresh) {
    return {Reason::stale_command, "it was made before this run or more than 5 s ago"};
  }
  if (command.sequence > now_us + kFresh) {
    return {Reason::stale_command, "it claims to be made in the future"};
  }
  if (command.sequence <= last_) {
    return {Reason::repeated_command, "this command or a later one has come before"};
  }
  last_ = command.sequence;
  return {};
}

std::string run_id_text(std::uint64_t id) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(id));
  return text.data();
}

bool parse_run_id(const std::string& text, std::uint64_t& id) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, id, 16);
  return text.size() <= 16 && error == std::errc() && stop == end;
}

}  // namespace hopscotch::apps
