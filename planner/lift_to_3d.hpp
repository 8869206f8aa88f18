#pragma once

#include "core/jump_plan.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// Where the target's soles are beside the jump line and how they are turned, in S.
struct SideTarget {
  double lateral = 0.0;  ///< Of the mid-point of both, to the left [m].
  double yaw = 0.0;      ///< To the left [rad].

  /// Straight ahead but for rounding.
  [[nodiscard]] bool is_straight() const;
};
[[nodiscard]] SideTarget side_target(const core::LandingTarget& target);

/// Turns a planar motion into knots of the whole robot in W and fills knots and phase times of
/// `plan`; its other members are left alone. Jumps straight ahead keep both legs alike; for jumps
/// to the side or with a turn see SideLift.
/// @return false if a leg cannot reach; the knots are then not usable.
[[nodiscard]] bool lift_to_3d(const PlanarModel& model, const PlanarMotion& motion,
                              const core::LandingTarget& target, core::JumpPlan& plan);

}  // namespace hopscotch::planner
