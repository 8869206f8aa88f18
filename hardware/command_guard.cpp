#include "hardware/command_guard.hpp"

#include <algorithm>

#include "model/motor.hpp"

namespace hopscotch::hardware {
namespace {

using core::JointCommand;
using core::JointVector;
using core::Range;

bool is_finite(const JointCommand& command) {
  return command.q.allFinite() && command.dq.allFinite() && command.kp.allFinite() &&
         command.kd.allFinite() && command.tau.allFinite();
}

/// Puts `value` into its range and counts if it was outside.
void limit(double& value, double lowest, double highest, std::uint64_t& count) {
  const double inside = std::clamp(value, lowest, highest);
  if (inside != value) ++count;
  value = inside;
}

}  // namespace

CommandGuardConfig CommandGuardConfig::load(const core::ConfigReader& section) {
  CommandGuardConfig config;
  config.kp_max = section.number("kp_max_Nm_per_rad", Range::positive());
  config.kd_max = section.number("kd_max_Nms_per_rad", Range::positive());
  config.overshoot_max = section.number("overshoot_max_rad", Range::closed(0.0, 1.0));
  config.damping = section.number("damping_Nms_per_rad", Range::above(0.0, config.kd_max));
  section.finish();
  return config;
}

CommandGuard::CommandGuard(const CommandGuardConfig& config, const model::RobotParameters& robot)
    : config_(config) {
  for (const core::Leg leg : core::kAllLegs) {
    for (int i = 0; i < core::kJointsPerLeg; ++i) {
      const auto joint = static_cast<core::Joint>(i);
      const model::JointRange range = model::joint_range(robot, leg, joint);
      const model::MotorParameters& motor = robot.motors[core::index(joint)];
      const int at = core::joint_index(leg, joint);
      lower_(at) = range.lower;
      upper_(at) = range.upper;
      speed_max_(at) = motor.speed_max;
      torque_max_(at) = motor.torque_max;
    }
  }
}

GuardVerdict CommandGuard::filter(const JointCommand& wanted, const JointVector& q,
                                  const JointVector& dq, JointCommand& safe) noexcept {
  if (must_damp(wanted, q, dq)) {
    const core::Stamp stamp = wanted.stamp;
    safe = JointCommand{};
    safe.stamp = stamp;
    safe.mode = core::DriveMode::damp;
    safe.kd.setConstant(config_.damping);
    return GuardVerdict::damped;
  }
  safe = wanted;
  if (wanted.mode == core::DriveMode::idle) return GuardVerdict::passed;
  limit_setpoints(safe);
  if (wanted.mode == core::DriveMode::active) limit_torque(safe, q, dq);
  const bool same = safe.q == wanted.q && safe.dq == wanted.dq && safe.kp == wanted.kp &&
                    safe.kd == wanted.kd && safe.tau == wanted.tau;
  return same ? GuardVerdict::passed : GuardVerdict::limited;
}

bool CommandGuard::must_damp(const JointCommand& wanted, const JointVector& q,
                             const JointVector& dq) noexcept {
  if (!is_finite(wanted) || !q.allFinite() || !dq.allFinite()) {
    ++counters_.not_finite;
    return true;
  }
  if (wanted.mode != core::DriveMode::active) return false;
  std::uint64_t outside = 0;
  for (int i = 0; i < core::kJoints; ++i) {
    const bool below = q(i) < lower_(i) - config_.overshoot_max;
    const bool above = q(i) > upper_(i) + config_.overshoot_max;
    if (below || above) ++outside;
  }
  counters_.overshoot += outside;
  return outside > 0;
}

void CommandGuard::limit_setpoints(JointCommand& command) noexcept {
  for (int i = 0; i < core::kJoints; ++i) {
    limit(command.q(i), lower_(i), upper_(i), counters_.position);
    limit(command.dq(i), -speed_max_(i), speed_max_(i), counters_.speed);
    limit(command.kp(i), 0.0, config_.kp_max, counters_.gain);
    limit(command.kd(i), 0.0, config_.kd_max, counters_.gain);
  }
}

void CommandGuard::limit_torque(JointCommand& command, const JointVector& q,
                                const JointVector& dq) noexcept {
  for (const core::Leg leg : core::kAllLegs) {
    const int at = core::leg_offset(leg);
    const auto part = [at](const JointVector& all) -> core::LegVector {
      return all.segment<core::kJointsPerLeg>(at);
    };
    const core::LegVector feedback = part(command.kp).cwiseProduct(part(command.q) - part(q)) +
                                     part(command.kd).cwiseProduct(part(command.dq) - part(dq));
    // The motors, not the joints, have limits: the ankle motor's torque also acts on the knee.
    core::LegVector demand = model::motor_torques(part(command.tau) + feedback);
    std::uint64_t cut = 0;
    for (int i = 0; i < core::kJointsPerLeg; ++i) {
      limit(demand(i), -torque_max_(at + i), torque_max_(at + i), cut);
    }
    if (cut == 0) continue;  // recomputing would change the last bits
    counters_.torque += cut;
    command.tau.segment<core::kJointsPerLeg>(at) = model::joint_torques(demand) - feedback;
  }
}

}  // namespace hopscotch::hardware
