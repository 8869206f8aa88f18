#pragma once

#include "core/joint_command.hpp"
#include "core/robot_layout.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::sim {

/// What the ten drives know of their joints at this tick.
struct DriveReading {
  core::JointVector q;   ///< Encoders [rad].
  core::JointVector dq;  ///< [rad/s]
};

/// Torque that the drives are asked for: feed-forward plus PD at the drives' own reading when
/// active, kd only towards zero speed when damping, none when idle [N·m].
[[nodiscard]] core::JointVector drive_demand(const core::JointCommand& command,
                                             const DriveReading& reading);

/// What the motors of both legs really give for a demand, eq. (9d) in motor space: torque, line and
/// power, scaled by `strength` [N·m].
/// @param joint_speed True speeds [rad/s].
[[nodiscard]] core::JointVector limited_by_motors(const model::RobotParameters& robot,
                                                  const core::JointVector& demand,
                                                  const core::JointVector& joint_speed,
                                                  double strength);

}  // namespace hopscotch::sim
