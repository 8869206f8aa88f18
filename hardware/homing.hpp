#pragma once

#include <string>

#include "core/config_reader.hpp"
#include "core/robot_layout.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::hardware {

/// How the robot must sit when it is turned on; section `homing` of the bus file. Drives count
/// their turns from power-up, so after a restart a shaft can be whole turns away from what its zero
/// offset says.
struct HomingConfig {
  core::LegVector pose = core::LegVector::Zero();  ///< Of both legs, in the home jig [rad].
  double tolerance = 0.0;                          ///< Per joint [rad].

  static HomingConfig load(const core::ConfigReader& section);
  /// Both legs; yaw and roll of the right one mirrored.
  [[nodiscard]] core::JointVector joints() const;
};

/// What speaks against enabling, with joints and numbers; empty when the pose is the home pose and
/// within all joint ranges. @param q Measured [rad]; NaN where a drive has not answered.
[[nodiscard]] std::string homing_problem(const HomingConfig& config,
                                         const model::RobotParameters& robot,
                                         const core::JointVector& q);

}  // namespace hopscotch::hardware
