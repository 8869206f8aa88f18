#include "control/jump_supervisor.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::control {

using core::Reason;
using core::RobotPhase;

double commit_time(const core::JumpPlan& plan, double speed) noexcept {
  double time = 0.0;
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    const core::JumpKnot& knot = plan.knots[i];
    if (knot.time >= plan.liftoff_time) break;
    if (knot.v_WG.z() <= speed) time = knot.time;
  }
  return time;
}

JumpSupervisor::JumpSupervisor(const SupervisorConfig& config, const model::RobotParameters& robot)
    : config_(config) {
  for (const core::Leg leg : core::kAllLegs) {
    for (int j = 0; j < core::kJointsPerLeg; ++j) {
      const auto joint = static_cast<core::Joint>(j);
      const model::JointRange range = model::joint_range(robot, leg, joint);
      lower_[core::joint_index(leg, joint)] = range.lower;
      upper_[core::joint_index(leg, joint)] = range.upper;
    }
  }
}

Reason JumpSupervisor::find_fault(const core::RobotState& state) const noexcept {
  const bool finite = state.q.allFinite() && state.dq.allFinite() && state.p_WB.allFinite() &&
                      state.R_WB.allFinite() && state.v_WB.allFinite() && state.w_WB.allFinite();
  if (!finite) return Reason::bad_sensor_value;
  const bool standing = core::is_standing(phase_) && !hopping_;
  const double tilt = standing ? config_.tilt_standing : config_.tilt_max;
  if (state.R_WB(2, 2) < std::cos(tilt)) return Reason::tilt_limit;
  const double beyond = std::max((lower_ - state.q).maxCoeff(), (state.q - upper_).maxCoeff());
  if (beyond > config_.joint_overshoot) return Reason::joint_limit;
  const double speed = standing ? config_.joint_speed_standing : config_.joint_speed_max;
  if (state.dq.cwiseAbs().maxCoeff() > speed) return Reason::joint_limit;
  return Reason::none;
}

bool JumpSupervisor::falls(const core::RobotState& state) noexcept {
  if (state.contact[0] || state.contact[1] || loaded_ > state.stamp) loaded_ = state.stamp;
  return core::is_standing(phase_) && state.stamp.since(loaded_) >= config_.fall_time;
}

bool JumpSupervisor::at_rest(const core::RobotState& state) const noexcept {
  return state.v_WB.norm() <= config_.rest_speed && state.w_WB.norm() <= config_.rest_rate;
}

void JumpSupervisor::advance(const core::RobotState& state, const core::JumpPlan& plan,
                             double plan_time) noexcept {
  const double flight = plan.touchdown_time - plan.liftoff_time;
  switch (phase_) {
    case RobotPhase::crouch:
      if (plan_time > commit_time_) phase_ = RobotPhase::takeoff;
      break;
    case RobotPhase::takeoff:
      if (plan_time >= plan.liftoff_time) phase_ = RobotPhase::flight;
      break;
    case RobotPhase::flight:
      if (plan_time >= plan.liftoff_time + config_.touchdown_from * flight &&
          (state.contact[0] || state.contact[1])) {
        phase_ = RobotPhase::landing;
        hopping_ = false;
      } else if (plan_time > plan.touchdown_time + config_.flight_overtime) {
        latch(Reason::no_touchdown);
      }
      break;
    case RobotPhase::landing:
      if (plan_time >= plan.duration - config_.rest_early && at_rest(state)) {
        phase_ = RobotPhase::stand;
      } else if (plan_time >= plan.duration) {
        phase_ = RobotPhase::recover;
      }
      break;
    case RobotPhase::recover:
      if (hopping_) {
        if (plan_time >= plan.liftoff_time) phase_ = RobotPhase::flight;
      } else if (at_rest(state)) {
        phase_ = RobotPhase::stand;
      }
      break;
    case RobotPhase::stand:
    case RobotPhase::hold:
    case RobotPhase::damp:
    case RobotPhase::fault: break;
  }
}

RobotPhase JumpSupervisor::update(const core::RobotState& state, const core::JumpPlan& plan,
                                  double plan_time) noexcept {
  if (const Reason fault = find_fault(state); fault != Reason::none && phase_ != RobotPhase::damp) {
    latch(fault);
  }
  if (falls(state)) {
    hold_waits_ = hold_waits_ || phase_ == RobotPhase::hold;
    phase_ = RobotPhase::flight;
    return phase_;
  }
  advance(state, plan, plan_time);
  if (hold_waits_ && !hopping_ && core::is_standing(phase_)) {
    phase_ = RobotPhase::hold;
    hold_waits_ = false;
  }
  return phase_;
}

void JumpSupervisor::begin_jump(const core::JumpPlan& plan) noexcept {
  if (phase_ != RobotPhase::stand && phase_ != RobotPhase::landing) return;
  commit_time_ = commit_time(plan, config_.commit_speed);
  phase_ = RobotPhase::crouch;
}

bool JumpSupervisor::call_off() noexcept {
  if (phase_ != RobotPhase::crouch) return false;
  phase_ = RobotPhase::landing;
  return true;
}

bool JumpSupervisor::hop() noexcept {
  if (phase_ != RobotPhase::landing && !core::is_standing(phase_)) return false;
  hold_waits_ = hold_waits_ || phase_ == RobotPhase::hold;
  phase_ = RobotPhase::recover;
  hopping_ = true;
  return true;
}

bool JumpSupervisor::hold() noexcept {
  if (core::is_limp(phase_)) return false;
  if ((core::is_standing(phase_) && !hopping_) || phase_ == RobotPhase::crouch) {
    phase_ = RobotPhase::hold;
  } else {
    hold_waits_ = true;
  }
  return true;
}

bool JumpSupervisor::release(const core::RobotState& state) noexcept {
  hold_waits_ = false;
  if (phase_ == RobotPhase::hold) phase_ = RobotPhase::stand;
  if (phase_ == RobotPhase::damp && find_fault(state) == Reason::none) phase_ = RobotPhase::stand;
  return !core::is_limp(phase_);
}

bool JumpSupervisor::damp() noexcept {
  if (phase_ == RobotPhase::fault) return false;
  phase_ = RobotPhase::damp;
  hold_waits_ = false;
  hopping_ = false;
  return true;
}

bool JumpSupervisor::clear_fault() noexcept {
  if (phase_ != RobotPhase::fault) return false;
  phase_ = RobotPhase::damp;
  fault_ = Reason::none;
  return true;
}

void JumpSupervisor::latch(Reason fault) noexcept {
  if (fault_ != Reason::none) return;
  fault_ = fault;
  phase_ = RobotPhase::fault;
  hold_waits_ = false;
  hopping_ = false;
}

}  // namespace hopscotch::control
