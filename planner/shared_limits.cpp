#include "planner/shared_limits.hpp"

#include <algorithm>

namespace hopscotch::planner {

namespace {

MotorLimit motor_limit(const model::RobotParameters& robot, const Reserves& reserves,
                       core::Joint which) {
  const model::MotorParameters& motor = robot.motors[core::index(which)];
  return {.torque = core::kLegs * reserves.torque * motor.torque_max,
          .speed = reserves.speed * motor.speed_max,
          .corner_speed = reserves.speed * motor.corner_speed,
          .power = core::kLegs * reserves.power * robot.motor_power_max};
}

/// Largest motoring power inside torque limit and torque-speed line: at the corner or, if the line
/// is long, where torque x speed peaks on it at half the top speed.
double largest_power(const MotorLimit& limit) {
  const double speed = std::max(limit.corner_speed, 0.5 * limit.speed);
  const double share = (limit.speed - speed) / (limit.speed - limit.corner_speed);
  return limit.torque * share * speed;
}

}  // namespace

MotorLimits motor_limits(const model::RobotParameters& robot, const Reserves& reserves) {
  return {motor_limit(robot, reserves, core::Joint::hip_pitch),
          motor_limit(robot, reserves, core::Joint::knee),
          motor_limit(robot, reserves, core::Joint::ankle)};
}

void MotorRows::bounds(std::span<double> lower, std::span<double> upper) const {
  int row = 0;
  for (const MotorLimit& limit : {limits.hip, limits.knee, limits.ankle}) {
    std::fill_n(lower.begin() + row, kPerMotor - 1, -1.0);
    std::fill_n(upper.begin() + row, kPerMotor - 1, 1.0);
    row += kPerMotor;
    const std::size_t power = static_cast<std::size_t>(row - 1);
    lower[power] = -kUnbounded;  // braking power is the plant's business
    upper[power] = largest_power(limit) <= limit.power ? kUnbounded : 1.0;
  }
}

void GroundRows::bounds(std::span<double> lower, std::span<double> upper) const {
  std::fill_n(lower.begin(), kRows, 0.0);
  std::fill_n(upper.begin(), kRows, kUnbounded);
  lower[0] = normal_force_min / weight;
  upper[0] = normal_force_max / weight;
}

GroundRows ground_rows(const model::PlanarChain& chain, const PlannerConfig& config,
                       double cop_margin) {
  return {.weight = chain.total_mass() * model::kGravity,
          .friction = config.reserves.friction * config.friction,
          .normal_force_min = config.normal_force_min,
          .normal_force_max = config.normal_force_max,
          .toe = chain.toe - cop_margin,
          .heel = chain.heel - cop_margin,
          .sole_height = chain.sole_height};
}

template <int Dof>
JointRows<Dof> joint_rows(const model::RobotParameters& robot, const PlannerConfig& config) {
  const model::JointRange hip = model::joint_range(robot, core::Leg::left, core::Joint::hip_pitch);
  const model::JointRange ankle = model::joint_range(robot, core::Leg::left, core::Joint::ankle);
  const MotorLimits limits = motor_limits(robot, config.reserves);
  return {.hip_lower = hip.lower + config.joint_margin,
          .hip_upper = hip.upper - config.joint_margin,
          .ankle_lower = ankle.lower + config.joint_margin,
          .ankle_upper = ankle.upper - config.joint_margin,
          .hip_speed = limits.hip.speed,
          .ankle_speed = limits.ankle.speed};
}

template JointRows<kStanceDof> joint_rows(const model::RobotParameters&, const PlannerConfig&);
template JointRows<kFlightDof> joint_rows(const model::RobotParameters&, const PlannerConfig&);

}  // namespace hopscotch::planner
