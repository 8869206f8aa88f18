#pragma once

#include <cstdint>
#include <optional>

#include "core/robot_state.hpp"

namespace hopscotch::core {

enum class ModeRequest : std::uint8_t { none, enable, jump, hold, stop, damp, clear_fault };

/// A landing target asked for by a person.
struct TargetOverride {
  double distance = kNaN;  ///< Along the heading [m].
  double height = kNaN;    ///< NaN: take the map's height [m].
  double lateral = 0.0;    ///< To the left [m].
  double yaw = 0.0;        ///< [rad]
};

/// The operator's wish: where to, and in which mode.
struct OperatorCommand {
  std::uint64_t run_id = 0;
  std::uint64_t sequence = 0;
  ModeRequest mode = ModeRequest::none;
  double goal_x = kNaN;  ///< Done when both heels are beyond, along the initial heading [m].
  std::optional<TargetOverride> target;
};

}  // namespace hopscotch::core
