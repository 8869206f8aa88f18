#pragma once

#include <array>

#include "control/control_config.hpp"
#include "core/jump_plan.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

// What a push leaves of a planned jump. Nothing in the air can right the trunk or change the speed
// of the CoM; where the legs are when they meet the ground, and when that is, can be chosen. Within
// the scatter of undisturbed jumps legs are not stretched and landings are the plan's. All of this
// is real-time safe.

/// Soles level and where they are planned relative to the CoM, however the trunk turns.
/// @param planned Where the body should be now. @param[in,out] q As planned [rad].
void keep_soles(const JointGains& gains, const core::RobotState& state,
                const core::JumpKnot& planned, core::JointVector& q) noexcept;

/// Where the body is in the plan that it follows.
struct PlanMoment {
  const core::JumpPlan& plan;
  double time;  ///< [s]
};

/// The legs of a flight that does not go as planned: soles level and where the CoM needs them; legs
/// stretched towards the ground when the trunk turns too far, so that it turns for less time, but
/// not into a riser that the target's profile shows before the landing place.
/// @param[in,out] q Planned angles for the commanded moment [rad].
void aim_legs(const JointGains& gains, const model::RobotParameters& robot,
              const core::RobotState& state, const PlanMoment& moment,
              core::JointVector& q) noexcept;

/// Begins the landing with the lean and the height above the soles that the robot came down with,
/// and lets what exceeds the plan's fade.
/// @param state At touchdown. @param[in,out] plan Its landing is changed.
/// @return False if the touchdown was as planned: nothing was changed.
bool shape_landing(const model::RobotParameters& robot, const core::RobotState& state,
                   core::JumpPlan& plan) noexcept;

/// Straighter legs pass more of the impact on than planned: the landing goes on from the height and
/// speed that it left, or the soles would be lifted off the ground again.
/// @param time Of the plan, after the impact [s].
void shape_after_impact(const model::RobotParameters& robot, const core::RobotState& state,
                        double time, core::JumpPlan& plan) noexcept;

/// How much lower the ankles are to be [m], and how fast that changes [m/s].
struct Stretch {
  double by, rate;
};
/// Lowers both ankles straight below where they are; the soles keep their pitch.
/// @param pitch Of the trunk [rad].
void stretch_legs(const model::RobotParameters& robot, double pitch, const Stretch& stretch,
                  core::JointVector& q, core::JointVector& dq) noexcept;
/// The same of each leg by its own measure.
void stretch_each_leg(const model::RobotParameters& robot, double pitch,
                      const std::array<Stretch, core::kLegs>& stretches, core::JointVector& q,
                      core::JointVector& dq) noexcept;

}  // namespace hopscotch::control
