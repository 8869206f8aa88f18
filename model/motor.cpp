#include "model/motor.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::model {

namespace {

constexpr Eigen::Index kKnee = static_cast<Eigen::Index>(core::Joint::knee);
constexpr Eigen::Index kAnkle = static_cast<Eigen::Index>(core::Joint::ankle);

/// Largest torque in the direction of motion: eq. (9d) and the torque-speed line [N·m].
double motoring_torque(const MotorParameters& motor, double power_max, double speed) {
  const double line =
      motor.torque_max * (motor.speed_max - speed) / (motor.speed_max - motor.corner_speed);
  const double electrical = std::clamp(line, 0.0, motor.torque_max);
  return std::min(electrical, power_max / std::max(speed, power_max / motor.torque_max));
}

/// Largest torque against the motion: back-EMF helps, so only torque and braking power bind [N·m].
double braking_torque(const MotorParameters& motor, double power_max, double speed) {
  return power_max / std::max(speed, power_max / motor.torque_max);
}

}  // namespace

core::LegVector motor_torques(const core::LegVector& joint_torque) {
  core::LegVector motor = joint_torque;
  motor(kKnee) -= joint_torque(kAnkle);
  return motor;
}

core::LegVector joint_torques(const core::LegVector& motor_torque) {
  core::LegVector joint = motor_torque;
  joint(kKnee) += motor_torque(kAnkle);
  return joint;
}

core::LegVector motor_speeds(const core::LegVector& joint_speed) {
  core::LegVector motor = joint_speed;
  motor(kAnkle) += joint_speed(kKnee);
  return motor;
}

TorqueBounds torque_bounds(const RobotParameters& robot, core::Joint motor, double speed,
                           double strength) {
  const MotorParameters& limits = robot.motors[core::index(motor)];
  const double magnitude = std::abs(speed);
  const double with = strength * motoring_torque(limits, robot.motor_power_max, magnitude);
  const double against = strength * braking_torque(limits, robot.braking_power_max, magnitude);
  return speed >= 0.0 ? TorqueBounds{-against, with} : TorqueBounds{-with, against};
}

core::LegVector saturate(const RobotParameters& robot, const core::LegVector& joint_torque,
                         const core::LegVector& joint_speed, double strength) {
  core::LegVector torque = motor_torques(joint_torque);
  const core::LegVector speed = motor_speeds(joint_speed);
  for (int i = 0; i < core::kJointsPerLeg; ++i) {
    const TorqueBounds bounds =
        torque_bounds(robot, static_cast<core::Joint>(i), speed(i), strength);
    torque(i) = std::clamp(torque(i), bounds.lower, bounds.upper);
  }
  return joint_torques(torque);
}

MotorLoad motor_load(const RobotParameters& robot, const core::LegVector& joint_torque,
                     const core::LegVector& joint_speed) {
  const core::LegVector torque = motor_torques(joint_torque);
  const core::LegVector speed = motor_speeds(joint_speed);
  MotorLoad load;
  for (int i = 0; i < core::kJointsPerLeg; ++i) {
    const MotorParameters& limits = robot.motors[static_cast<std::size_t>(i)];
    load.torque_ratio(i) = std::abs(torque(i)) / limits.torque_max;
    load.speed_ratio(i) = std::abs(speed(i)) / limits.speed_max;
    load.power_ratio(i) = std::max(0.0, torque(i) * speed(i)) / robot.motor_power_max;
  }
  return load;
}

}  // namespace hopscotch::model
