#pragma once

#include <cstdint>
#include <string_view>

#include "core/contact_wrenches.hpp"
#include "core/reason.hpp"
#include "core/robot_state.hpp"
#include "core/time.hpp"

namespace hopscotch::core {

/// What the robot is doing. The transitions stand in `control/jump_supervisor.hpp`.
enum class RobotPhase : std::uint8_t { stand, takeoff, flight, landing, damp };

constexpr std::string_view robot_phase_name(RobotPhase phase) {
  switch (phase) {
    case RobotPhase::stand: return "stand";
    case RobotPhase::takeoff: return "takeoff";
    case RobotPhase::flight: return "flight";
    case RobotPhase::landing: return "landing";
    case RobotPhase::damp: return "damp";
  }
  return "damp";
}

/// What the control tick reports about itself, every tick.
struct ControlStatus {
  Stamp stamp;
  RobotPhase phase = RobotPhase::stand;
  std::uint64_t plan_id = 0;    ///< Of the plan being executed; 0 before the first.
  double plan_time = kNaN;      ///< Since the start of that plan, as the body lives it [s].
  Reason fault = Reason::none;  ///< Latched; `none` while all is well.
  ContactWrenches wrenches{};   ///< Ground on feet as asked of the torque law.
};

}  // namespace hopscotch::core
