#pragma once

#include <optional>

#include "core/config_reader.hpp"
#include "core/robot_layout.hpp"
#include "core/robot_state.hpp"
#include "model/planar_dynamics.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::model {

/// The posture in which the robot stands, looks, and starts and ends its jumps: section
/// `stand_posture` of the configuration. Heights and places are of the whole-body CoM.
struct StandPosture {
  double com_height = core::kNaN;   ///< Above the sole [m].
  double com_x = core::kNaN;        ///< Ahead of the sole centre F [m].
  double trunk_pitch = core::kNaN;  ///< + nose down [rad]; lets the camera see the ground ahead.

  /// @throws core::ConfigError naming the key, its value and the violated rule.
  static StandPosture load(const core::ConfigReader& section);
};

/// The whole robot in that posture, feet flat, zero yaw and roll.
struct StandPose {
  core::JointVector q = core::JointVector::Constant(core::kNaN);  ///< Both legs alike [rad].
  LinkArray<double> pitch{};         ///< Of the sagittal links; foot 0 [rad].
  double trunk_height = core::kNaN;  ///< Trunk origin B above the sole [m].
  double trunk_x = core::kNaN;       ///< Trunk origin B ahead of the sole centre F [m].
  double trunk_pitch = core::kNaN;   ///< [rad]
};

/// Pitches of shank and thigh that put the whole-body CoM at `com` from the ankle axis while foot
/// and trunk have the pitches of `known`; knee backward. Closed form. Nothing if out of reach.
[[nodiscard]] std::optional<LinkArray<double>> links_from_com(const PlanarDynamics& dynamics,
                                                              const PlanarVector<double>& com,
                                                              const LinkArray<double>& known);

/// Nothing if the legs cannot reach the posture or a joint would leave its range.
[[nodiscard]] std::optional<StandPose> stand_pose(const RobotParameters& robot,
                                                  const StandPosture& posture);

}  // namespace hopscotch::model
