#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/reason.hpp"
#include "core/robot_state.hpp"

namespace hopscotch::core {

enum class ModeRequest : std::uint8_t { none, enable, jump, hold, stop, damp, clear_fault };

/// As typed after `hopscotch command`.
constexpr std::string_view mode_request_name(ModeRequest mode) {
  switch (mode) {
    case ModeRequest::none: return "none";
    case ModeRequest::enable: return "enable";
    case ModeRequest::jump: return "jump";
    case ModeRequest::hold: return "hold";
    case ModeRequest::stop: return "stop";
    case ModeRequest::damp: return "damp";
    case ModeRequest::clear_fault: return "clear-fault";
  }
  return "none";
}

/// A landing target asked for by a person.
struct TargetOverride {
  double distance = kNaN;  ///< Along the heading [m].
  double height = kNaN;    ///< NaN: take the map's height [m].
  double lateral = 0.0;    ///< To the left [m].
  double yaw = 0.0;        ///< [rad]
};

/// One wish of the operator: a mode, or where to land next, or to drop an earlier target.
struct OperatorCommand {
  std::uint64_t run_id = 0;    ///< Of the run that it is meant for.
  std::uint64_t sequence = 0;  ///< Sender's wall clock since 1970 [us]: later commands have more.
  ModeRequest mode = ModeRequest::none;  ///< `none`: `target` or `clear_target` is the wish.
  double goal_x = kNaN;  ///< Done when both heels are beyond, along the initial heading [m].
  std::optional<TargetOverride> target;
  bool clear_target = false;
};

/// The answer to a command. Every command gets exactly one, a target once it has been planned.
struct OperatorAnswer {
  OperatorCommand command;
  Refusal refusal;         ///< Reason `none`: accepted.
  double start_in = kNaN;  ///< Until the jump starts, or may be asked for again [s]; NaN: unknown.
  std::string remark;      ///< What follows, for people.

  [[nodiscard]] bool accepted() const { return refusal.reason == Reason::none; }
};

}  // namespace hopscotch::core
