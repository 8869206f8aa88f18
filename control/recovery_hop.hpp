#pragma once

#include <Eigen/Core>

#include "control/stand_plan.hpp"
#include "core/config_reader.hpp"
#include "core/jump_plan.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// Tuning of the recovery hop: section `control.recovery_hop` of the configuration.
struct RecoveryHopConfig {
  double excess_along = 0.0;       ///< Capture point so far beyond toe or heel: the robot hops [m].
  double excess_across = 0.0;      ///< The same beyond the outer sole's centre line [m].
  double wait = 0.0;               ///< After a touchdown, before the next hop may begin [s].
  double lift_speed = 0.0;         ///< Of the CoM at lift-off, upward [m/s].
  double push_acceleration = 0.0;  ///< Of the CoM before it [m/s^2].
  double clearance = 0.0;          ///< Of the soles in mid-flight [m].
  double landing_height = 0.0;     ///< Of the CoM over the soles at touchdown [m].
  double reach_share = 0.0;        ///< Of the way to the capture point that the soles go [-].
  double reach_max = 0.0;          ///< Of the soles from below the CoM, in each direction [m].

  static RecoveryHopConfig load(const core::ConfigReader& section);
};

/// The capture point, where the foot would have to be for the CoM to come to rest over it, from the
/// mid-point of the soles, along and across the soles' heading [m]. Real-time safe.
[[nodiscard]] Eigen::Vector2d capture_point(const model::RobotParameters& robot,
                                            const core::RobotState& state) noexcept;

/// True once the soles cannot bring the body to rest where they are: the capture point lies beyond
/// them. Real-time safe.
[[nodiscard]] bool must_hop(const RecoveryHopConfig& config, const model::RobotParameters& robot,
                            const core::RobotState& state) noexcept;

/// A small jump with both feet towards the capture point, from the present motion: a push about the
/// edge of the soles that the body falls over, a ballistic flight, and the stand posture at rest
/// over the new place, on ground as high as the present one. False, with `plan` spoilt, if the legs
/// cannot reach that. @param[out] plan Replaced; id 0, as nobody planned it. Real-time safe.
[[nodiscard]] bool make_recovery_hop(const RecoveryHopConfig& config,
                                     const model::RobotParameters& robot,
                                     const core::RobotState& state, const StandTarget& stand,
                                     core::JumpPlan& plan) noexcept;

}  // namespace hopscotch::control
