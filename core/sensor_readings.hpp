#pragma once

#include "core/robot_state.hpp"

namespace hopscotch::core {

/// What the robot measures at one tick; all the controller ever gets besides depth frames.
struct SensorReadings {
  Stamp stamp;
  JointVector q = JointVector::Constant(kNaN);    ///< Encoders, joint side [rad].
  JointVector dq = JointVector::Constant(kNaN);   ///< [rad/s]
  JointVector tau = JointVector::Constant(kNaN);  ///< Torque from motor current, joint side [N·m].
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Constant(kNaN);  ///< Gyroscope, in B [rad/s].
  Eigen::Vector3d f_B = Eigen::Vector3d::Constant(kNaN);     ///< Specific force at B, in B [m/s^2].
};

}  // namespace hopscotch::core
