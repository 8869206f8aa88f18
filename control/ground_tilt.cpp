#include "control/ground_tilt.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/kinematics.hpp"

namespace hopscotch::control {

namespace {

using core::Joint;
using core::joint_index;

/// Soles at rest on level ground scatter so much, with the estimated trunk and the map [rad].
constexpr double kScatter = 0.010;
/// From here on all of the tilt counts [rad].
constexpr double kSure = 0.025;
/// Steeper ground is no landing place; a foot that stands so lies on an edge [rad].
constexpr double kSteepest = 0.20;

double beyond_scatter(double tilt) {
  const double share = (std::abs(tilt) - kScatter) / (kSure - kScatter);
  return tilt * std::clamp(share, 0.0, 1.0);
}

double pitch_of(const Eigen::Isometry3d& X_WF) {
  return -std::asin(std::clamp(X_WF.linear()(2, 0), -1.0, 1.0));
}

/// The pressure asked for lies well within the sole: one that has risen about toe or heel comes
/// down under it.
bool presses_flat(const Eigen::Isometry3d& X_WF, const core::Wrench& asked) {
  constexpr double kWithin = 0.05;  // of the sole's centre; heel and toe are 0.075 away [m]
  constexpr double kLoaded = 20.0;  // [N]
  const double load = asked.force.z();
  if (load < kLoaded) return false;
  return std::abs(asked.moment.dot(X_WF.linear().col(1))) <= kWithin * load;
}

/// Of a sole about its lateral axis, + toes going down [rad/s].
double pitch_rate(const core::RobotState& state, core::Leg leg) {
  return state.w_WB.dot(state.R_WB.col(1)) + state.dq[joint_index(leg, Joint::hip_pitch)] +
         state.dq[joint_index(leg, Joint::knee)] + state.dq[joint_index(leg, Joint::ankle)];
}

}  // namespace

double tilt_of(const core::LandingTarget& target) noexcept {
  constexpr double kHalf = 0.06;  // a little within toe and heel [m]
  using Profile = core::TerrainProfile;
  const auto heel = static_cast<std::size_t>(Profile::sample(target.distance - kHalf));
  const auto toe = static_cast<std::size_t>(Profile::sample(target.distance + kHalf));
  if (toe <= heel) return 0.0;
  const double rise = target.profile.mean[toe] - target.profile.mean[heel];
  const double run = Profile::kStep * static_cast<double>(toe - heel);
  if (!std::isfinite(rise)) return 0.0;
  return std::clamp(-std::atan2(rise, run), -kSteepest, kSteepest);
}

void GroundTilt::observe(const model::RobotParameters& robot, const core::RobotState& state,
                         const core::ContactWrenches& asked, double dt) noexcept {
  const auto soles = model::sole_poses(robot, state);
  if (!presses_flat(soles[0], asked[0]) || !presses_flat(soles[1], asked[1])) return;
  look_at_soles(robot, state, dt);
}

void GroundTilt::look_at_soles(const model::RobotParameters& robot, const core::RobotState& state,
                               double dt) noexcept {
  constexpr double kRest = 0.3;       // slower soles do not turn [rad/s]
  constexpr double kTime = 0.04;      // of the low-pass: the trunk still swings [s]
  constexpr double kDifferent = 0.1;  // one sole stands on something else [rad]
  if (!state.contact[0] || !state.contact[1]) return;
  for (const core::Leg leg : core::kAllLegs) {
    if (std::abs(pitch_rate(state, leg)) > kRest) return;
  }
  const auto soles = model::sole_poses(robot, state);
  const std::array<double, 2> pitch{pitch_of(soles[0]), pitch_of(soles[1])};
  if (std::abs(pitch[0] - pitch[1]) > kDifferent) return;
  const double mean = 0.5 * (pitch[0] + pitch[1]);
  if (std::abs(mean) > kSteepest) return;
  under_ += std::min(dt / kTime, 1.0) * (mean - under_);
}

void GroundTilt::begin_on(const model::RobotParameters& robot,
                          const core::RobotState& state) noexcept {
  constexpr double kLong = 1.0;  // the low-pass has nothing to remember [s]
  look_at_soles(robot, state, kLong);
}

double GroundTilt::under() const noexcept {
  return beyond_scatter(under_);
}

double GroundTilt::in_flight(double flown) const noexcept {
  // Toes leave the ground as they stood, and are where they are to be before the ground can come.
  constexpr double kFrom = 0.25;
  constexpr double kTo = 0.75;
  const double s = std::clamp((flown - kFrom) / (kTo - kFrom), 0.0, 1.0);
  return std::lerp(under(), beyond_scatter(ahead_), s * s * (3.0 - 2.0 * s));
}

void tilt_soles(double tilt, core::JointVector& q) noexcept {
  for (const core::Leg leg : core::kAllLegs) q[joint_index(leg, Joint::ankle)] += tilt;
}

}  // namespace hopscotch::control
