#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>

#include "core/robot_layout.hpp"
#include "core/time.hpp"

namespace hopscotch::core {

/// Not-a-number, the start value of everything that is measured.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Where the robot is and how it moves. Frames: W world, B trunk (origin at the trunk's CoM).
struct RobotState {
  Stamp stamp;                                             ///< Of the measurement.
  Eigen::Vector3d p_WB = Eigen::Vector3d::Constant(kNaN);  ///< [m]
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Constant(kNaN);  ///< Rotation B to W.
  Eigen::Vector3d v_WB = Eigen::Vector3d::Constant(kNaN);  ///< Of B in W, in W [m/s].
  Eigen::Vector3d w_WB = Eigen::Vector3d::Constant(kNaN);  ///< Of B in W, in W [rad/s].
  JointVector q = JointVector::Constant(kNaN);             ///< Straight leg is 0 [rad].
  JointVector dq = JointVector::Constant(kNaN);            ///< [rad/s]
  std::array<bool, kLegs> contact{};                       ///< Foot bears load.
};

}  // namespace hopscotch::core
