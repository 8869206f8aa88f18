#pragma once

#include "core/robot_layout.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::model {

/// Maps between joints and motors of one leg. The ankle motor sits on the thigh and holds the foot
/// relative to it, so it turns with q_knee + q_ankle; the knee motor's own share of the knee torque
/// is tau_knee - tau_ankle (all referred to the joint side of each reduction).
[[nodiscard]] core::LegVector motor_torques(const core::LegVector& joint_torque);
[[nodiscard]] core::LegVector joint_torques(const core::LegVector& motor_torque);
[[nodiscard]] core::LegVector motor_speeds(const core::LegVector& joint_speed);

/// Largest torque one motor can give at a speed: torque limit, torque-speed line and power limit,
/// eq. (9d). Motoring and braking directions differ.
struct TorqueBounds {
  double lower = 0.0;  ///< [N·m]
  double upper = 0.0;  ///< [N·m]
};
/// @param speed    Of the motor, referred to the joint side of its reduction [rad/s].
/// @param strength Scales torque, line and power; 1 is nominal.
[[nodiscard]] TorqueBounds torque_bounds(const RobotParameters& robot, core::Joint motor,
                                         double speed, double strength = 1.0);

/// Joint torques that a leg's motors can really give for a demand: each motor's share is cut to its
/// bounds, then mapped back to the joints. Real-time safe.
[[nodiscard]] core::LegVector saturate(const RobotParameters& robot,
                                       const core::LegVector& joint_torque,
                                       const core::LegVector& joint_speed, double strength = 1.0);

/// Use of the limits by one leg, each as a share of its limit (1 = at the limit).
struct MotorLoad {
  core::LegVector torque_ratio;  ///< |tau| / torque_max
  core::LegVector speed_ratio;   ///< |speed| / speed_max
  core::LegVector power_ratio;   ///< motoring power / motor_power_max, 0 when braking
};
[[nodiscard]] MotorLoad motor_load(const RobotParameters& robot,
                                   const core::LegVector& joint_torque,
                                   const core::LegVector& joint_speed);

}  // namespace hopscotch::model
