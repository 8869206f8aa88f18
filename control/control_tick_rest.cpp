#include <algorithm>

#include "control/control_tick.hpp"

// What is left of a jump may be planned anew while it pushes off or lands (docs/decisions/0160).

namespace hopscotch::control {

using core::RobotPhase;

bool ControlTick::may_go_on_otherwise() const noexcept {
  if (plan_.id == 0 || supervisor_.is_hopping()) return false;
  if (core::is_pushing_off(phase())) return true;
  return phase() == RobotPhase::landing && state_.stamp.since(touchdown_) >= kImpactTime;
}

std::optional<ControlTick::RestPlace> ControlTick::rest_place(double begin) const noexcept {
  const std::size_t next = knot_index(plan_, begin) + 1;
  if (next >= plan_.knot_count) return std::nullopt;
  if (phase() == RobotPhase::landing) return RestPlace{next, begin};
  const bool pushes = plan_.knots[next].phase == core::JumpPhase::takeoff;
  if (!pushes || next <= replaced_knot_) return std::nullopt;
  return RestPlace{next, plan_.knots[next].time};
}

std::optional<ControlTick::RestQuestion> ControlTick::rest_question(double ahead) const noexcept {
  if (!may_go_on_otherwise()) return std::nullopt;
  const double time = command_time(state_.stamp);
  const std::optional<RestPlace> place = rest_place(time + ahead);
  if (!place) return std::nullopt;
  const double body_time = time - config_.actuation_delay;
  const double phase_begin = phase() == RobotPhase::landing ? plan_.touchdown_time : 0.0;
  return RestQuestion{*place, extrapolate(state_, place->begin - body_time,
                                          sample_plan(plan_, std::max(phase_begin, body_time)),
                                          sample_plan(plan_, place->begin))};
}

bool ControlTick::replace_rest(const core::JumpPlan& rest, const RestPlace& place) noexcept {
  constexpr double kLate = 0.002;  // [s]
  const auto& [knot, begin] = place;
  const std::size_t end = knot + rest.knot_count;
  const bool lands = phase() == RobotPhase::landing;
  const bool fits = may_go_on_otherwise() && rest.id == plan_.id && knot > replaced_knot_ &&
                    (lands ? end <= core::JumpPlan::kMaxKnots : end == plan_.knot_count);
  if (!fits || command_time(state_.stamp) > begin + kLate) return false;
  if (!lands) {
    plan_.liftoff_time = begin + rest.liftoff_time;
    plan_.touchdown_time = begin + rest.touchdown_time;
  }
  plan_.knots[knot - 1].dt = begin - plan_.knots[knot - 1].time;
  for (std::size_t i = 0; i < rest.knot_count; ++i) {
    plan_.knots[knot + i] = rest.knots[i];
    plan_.knots[knot + i].time += begin;
  }
  plan_.knot_count = end;
  plan_.duration = begin + rest.duration;
  replaced_knot_ = knot;
  replaced_ = state_.stamp;
  return true;
}

}  // namespace hopscotch::control
