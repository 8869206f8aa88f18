#include "control/ground_tilt.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "control/disturbed_flight.hpp"
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

double pitch_of(const Eigen::Isometry3d& X_WF) {
  return -std::asin(std::clamp(X_WF.linear()(2, 0), -1.0, 1.0));
}

/// From sole to sole, + left higher [rad]; 0 of soles at one place.
double slope_across(const std::array<Eigen::Isometry3d, core::kLegs>& X_WF) {
  const Eigen::Vector3d to_left = X_WF[0].translation() - X_WF[1].translation();
  const double spacing = to_left.head<2>().norm();
  if (!(spacing > 0.0)) return 0.0;
  return std::clamp(std::atan2(to_left.z(), spacing), -kSteepest, kSteepest);
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

/// From sole to sole of a posture, across the trunk [m].
double stance_width(const model::RobotParameters& robot, const core::JointVector& q) {
  const auto side = [&](core::Leg leg) {
    const core::LegVector angles = q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
    return model::leg_poses(robot, leg, angles).X_BF.translation().y();
  };
  return side(core::Leg::left) - side(core::Leg::right);
}

/// Of a sole about its lateral axis, + toes going down [rad/s].
double pitch_rate(const core::RobotState& state, core::Leg leg) {
  return state.w_WB.dot(state.R_WB.col(1)) + state.dq[joint_index(leg, Joint::hip_pitch)] +
         state.dq[joint_index(leg, Joint::knee)] + state.dq[joint_index(leg, Joint::ankle)];
}

}  // namespace

double beyond_scatter(double slope) noexcept {
  const double share = (std::abs(slope) - kScatter) / (kSure - kScatter);
  return slope * std::clamp(share, 0.0, 1.0);
}

double slope_along(const core::TerrainProfile& profile, double x) noexcept {
  constexpr double kHalf = 0.06;  // a little within toe and heel [m]
  using Profile = core::TerrainProfile;
  const auto heel = static_cast<std::size_t>(Profile::sample(x - kHalf));
  const auto toe = static_cast<std::size_t>(Profile::sample(x + kHalf));
  if (toe <= heel) return 0.0;
  const double rise = profile.mean[toe] - profile.mean[heel];
  const double run = Profile::kStep * static_cast<double>(toe - heel);
  if (!std::isfinite(rise)) return 0.0;
  return std::clamp(-std::atan2(rise, run), -kSteepest, kSteepest);
}

GroundSlope slope_ahead(const core::LandingTarget& target) noexcept {
  return {slope_along(target.profile, target.distance), slope_across(target.X_WF)};
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
  const double gain = std::min(dt / kTime, 1.0);
  under_.along += gain * (mean - under_.along);
  under_.across += gain * (slope_across(soles) - under_.across);
}

void GroundTilt::begin_on(const model::RobotParameters& robot,
                          const core::RobotState& state) noexcept {
  constexpr double kLong = 1.0;  // the low-pass has nothing to remember [s]
  look_at_soles(robot, state, kLong);
}

GroundSlope GroundTilt::under() const noexcept {
  return {beyond_scatter(under_.along), beyond_scatter(under_.across)};
}

GroundSlope GroundTilt::in_flight(double flown) const noexcept {
  // Toes leave the ground as they stood, and are where they are to be before the ground can come.
  constexpr double kFrom = 0.25;
  constexpr double kTo = 0.75;
  const double t = std::clamp((flown - kFrom) / (kTo - kFrom), 0.0, 1.0);
  const double s = t * t * (3.0 - 2.0 * t);
  const GroundSlope from = under();
  return {std::lerp(from.along, beyond_scatter(ahead_.along), s),
          std::lerp(from.across, beyond_scatter(ahead_.across), s)};
}

void lay_soles(const model::RobotParameters& robot, double pitch, const GroundSlope& slope,
               core::JointVector& q) noexcept {
  if (slope.across != 0.0) {
    core::JointVector unused = core::JointVector::Zero();
    const double half = 0.5 * stance_width(robot, q) * std::tan(slope.across);
    const std::array<Stretch, core::kLegs> reach{Stretch{-half, 0.0}, Stretch{half, 0.0}};
    stretch_each_leg(robot, pitch, reach, q, unused);
  }
  for (const core::Leg leg : core::kAllLegs) q[joint_index(leg, Joint::ankle)] += slope.along;
}

core::RobotState on_level_ground(const model::RobotParameters& robot, const core::RobotState& state,
                                 const GroundSlope& slope) noexcept {
  core::RobotState level = state;
  const double pitch = model::rpy_from_rotation(state.R_WB).y();
  lay_soles(robot, pitch, {-slope.along, -slope.across}, level.q);
  return level;
}

}  // namespace hopscotch::control
