#pragma once

#include <cstdint>
#include <string_view>

#include "core/contact_wrenches.hpp"
#include "core/reason.hpp"
#include "core/robot_state.hpp"
#include "core/time.hpp"

namespace hopscotch::core {

/// What the robot is doing. The transitions stand in `control/jump_supervisor.hpp`.
enum class RobotPhase : std::uint8_t {
  stand,    ///< At rest, ready to jump.
  crouch,   ///< A takeoff that can still be called off.
  takeoff,  ///< Past the commit point.
  flight,
  landing,
  recover,  ///< After a landing that did not come to rest in time.
  hold,     ///< Stands and does not jump, as the operator wishes.
  damp,     ///< Joints brake, as the operator wishes.
  fault,    ///< Joints brake: a latched fault.
};

constexpr std::string_view robot_phase_name(RobotPhase phase) {
  switch (phase) {
    case RobotPhase::stand: return "stand";
    case RobotPhase::crouch: return "crouch";
    case RobotPhase::takeoff: return "takeoff";
    case RobotPhase::flight: return "flight";
    case RobotPhase::landing: return "landing";
    case RobotPhase::recover: return "recover";
    case RobotPhase::hold: return "hold";
    case RobotPhase::damp: return "damp";
    case RobotPhase::fault: return "fault";
  }
  return "fault";
}

/// The joints follow no plan: the drives brake.
constexpr bool is_limp(RobotPhase phase) {
  return phase == RobotPhase::damp || phase == RobotPhase::fault;
}
/// On the ground for good: at rest or coming to rest, not pushing off.
constexpr bool is_standing(RobotPhase phase) {
  return phase == RobotPhase::stand || phase == RobotPhase::hold || phase == RobotPhase::recover;
}
/// Follows the plan's takeoff, be it before or past the commit point.
constexpr bool is_pushing_off(RobotPhase phase) {
  return phase == RobotPhase::crouch || phase == RobotPhase::takeoff;
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
