#pragma once

#include "core/contact_wrenches.hpp"
#include "core/landing_target.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// Pitch that soles need to lie flat at the landing place, by the target's profile, + toes down
/// [rad]; 0 where the profile does not know the ground under toe and heel. Real-time safe.
[[nodiscard]] double tilt_of(const core::LandingTarget& target) noexcept;

/// How the ground under the soles slopes along their heading. Plans know level soles only: on a
/// slope of s their ankles would be off by s, and push with the stiffness of the joint times that.
/// What is reported is 0 up to the scatter of level ground. Angles are pitches of soles, + toes
/// down [rad]. Real-time safe throughout.
class GroundTilt {
 public:
  /// Switched on: soles that lie still on the ground tell at once how it slopes.
  void begin_on(const model::RobotParameters& robot, const core::RobotState& state) noexcept;
  /// A jump begins that leads to such ground.
  void begin(double ahead) noexcept { ahead_ = ahead; }
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
  [[nodiscard]] double under() const noexcept;
  /// On the way to the landing place. @param flown Share of the planned flight, 0 to 1.
  [[nodiscard]] double in_flight(double flown) const noexcept;

 private:
  void look_at_soles(const model::RobotParameters& robot, const core::RobotState& state,
                     double dt) noexcept;

  double under_ = 0.0;
  double ahead_ = 0.0;
};

/// Adds to the ankles of both legs. @param[in,out] q [rad]
void tilt_soles(double tilt, core::JointVector& q) noexcept;

}  // namespace hopscotch::control
