#pragma once

#include "core/contact_wrenches.hpp"
#include "core/landing_target.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// How ground slopes under a pair of soles.
struct GroundSlope {
  double along = 0.0;   ///< Pitch of soles that lie on it, + toes down [rad].
  double across = 0.0;  ///< From sole to sole, + the left one stands higher [rad].
};

/// Of the ground at the landing place: along by the target's profile, 0 where that does not know
/// the ground under toe and heel; across by its soles. Real-time safe.
[[nodiscard]] GroundSlope slope_ahead(const core::LandingTarget& target) noexcept;
/// Pitch of soles at a place of a profile [m], likewise.
[[nodiscard]] double slope_along(const core::TerrainProfile& profile, double x) noexcept;

/// What exceeds the scatter of level ground of a slope [rad].
[[nodiscard]] double beyond_scatter(double slope) noexcept;

/// How the ground under the soles slopes along their heading and across it. Plans know level soles
/// at one height only: on a slope of s their ankles would be off by s, and push with the stiffness
/// of the joint times that; across, one leg would be as much too long as the other is too short.
/// What is reported is 0 up to the scatter of level ground. Real-time safe throughout.
class GroundTilt {
 public:
  /// Switched on: soles that lie still on the ground tell at once how it slopes.
  void begin_on(const model::RobotParameters& robot, const core::RobotState& state) noexcept;
  /// A jump begins that leads to such ground.
  void begin(const GroundSlope& ahead) noexcept { ahead_ = ahead; }
  /// Both feet go up, or come down again, on the ground where they are.
  void stay() noexcept { ahead_ = under_; }
  /// Touchdown: what lay ahead is under the soles now.
  void land() noexcept { under_ = ahead_; }
  /// Soles that bear load and do not turn lie on the ground: they tell how it slopes. Those that
  /// are asked to push near toe or heel may have risen about it, and tell nothing.
  /// @param asked What the controller asks of the ground. @param dt Since the last call [s].
  void observe(const model::RobotParameters& robot, const core::RobotState& state,
               const core::ContactWrenches& asked, double dt) noexcept;

  /// Where the feet stand, or stood last.
  [[nodiscard]] GroundSlope under() const noexcept;
  /// On the way to the landing place. @param flown Share of the planned flight, 0 to 1.
  [[nodiscard]] GroundSlope in_flight(double flown) const noexcept;

 private:
  void look_at_soles(const model::RobotParameters& robot, const core::RobotState& state,
                     double dt) noexcept;

  GroundSlope under_;
  GroundSlope ahead_;
};

/// Lays the soles of a posture for level ground on a slope: ankles turn along it; across it one leg
/// gets shorter and the other one longer, and the trunk stays upright.
/// @param pitch Of the trunk [rad]. @param[in,out] q [rad]
void lay_soles(const model::RobotParameters& robot, double pitch, const GroundSlope& slope,
               core::JointVector& q) noexcept;
/// The reverse: the posture for level ground of a robot that stands on a slope.
[[nodiscard]] core::RobotState on_level_ground(const model::RobotParameters& robot,
                                               const core::RobotState& state,
                                               const GroundSlope& slope) noexcept;

}  // namespace hopscotch::control
