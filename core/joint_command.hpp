#pragma once

#include <cstdint>

#include "core/robot_layout.hpp"
#include "core/time.hpp"

namespace hopscotch::core {

enum class DriveMode : std::uint8_t {
  idle,    ///< Drives give no torque.
  damp,    ///< Drives brake: only `kd` acts, towards zero speed.
  active,  ///< tau + kp (q - q_measured) + kd (dq - dq_measured).
};

/// Set-points of the ten drives for the coming tick. The drive closes the PD loop itself, at its
/// own reading; the host's latency delays the set-points only. Starts as zero torque.
struct JointCommand {
  Stamp stamp;
  DriveMode mode = DriveMode::idle;
  JointVector q = JointVector::Zero();    ///< [rad]
  JointVector dq = JointVector::Zero();   ///< [rad/s]
  JointVector kp = JointVector::Zero();   ///< [N·m/rad]
  JointVector kd = JointVector::Zero();   ///< [N·m·s/rad]
  JointVector tau = JointVector::Zero();  ///< Feed-forward, joint side [N·m].
};

}  // namespace hopscotch::core
