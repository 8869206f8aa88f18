#include "control/jump_supervisor.hpp"

#include <cmath>

namespace hopscotch::control {

using core::Reason;
using core::RobotPhase;

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
  if (state.R_WB(2, 2) < std::cos(config_.tilt_max)) return Reason::tilt_limit;
  const double beyond = std::max((lower_ - state.q).maxCoeff(), (state.q - upper_).maxCoeff());
  if (beyond > config_.joint_overshoot) return Reason::joint_limit;
  if (state.dq.cwiseAbs().maxCoeff() > config_.joint_speed_max) return Reason::joint_limit;
  return Reason::none;
}

RobotPhase JumpSupervisor::update(const core::RobotState& state, const core::JumpPlan& plan,
                                  double plan_time) noexcept {
  if (const Reason fault = find_fault(state); fault != Reason::none) latch(fault);
  const double flight = plan.touchdown_time - plan.liftoff_time;
  switch (phase_) {
    case RobotPhase::takeoff:
      if (plan_time >= plan.liftoff_time) phase_ = RobotPhase::flight;
      break;
    case RobotPhase::flight:
      if (plan_time >= plan.liftoff_time + config_.touchdown_from * flight &&
          (state.contact[0] || state.contact[1])) {
        phase_ = RobotPhase::landing;
      } else if (plan_time > plan.touchdown_time + config_.flight_overtime) {
        latch(Reason::no_touchdown);
      }
      break;
    case RobotPhase::landing:
      if (plan_time >= plan.duration) phase_ = RobotPhase::stand;
      break;
    case RobotPhase::stand:
    case RobotPhase::damp: break;
  }
  return phase_;
}

void JumpSupervisor::begin_jump() noexcept {
  if (phase_ == RobotPhase::stand || phase_ == RobotPhase::landing) phase_ = RobotPhase::takeoff;
}

void JumpSupervisor::latch(Reason fault) noexcept {
  if (fault_ != Reason::none) return;
  fault_ = fault;
  phase_ = RobotPhase::damp;
}

}  // namespace hopscotch::control
