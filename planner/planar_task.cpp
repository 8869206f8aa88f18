#include "planner/planar_task.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "model/kinematics.hpp"
#include "planner/lift_to_3d.hpp"

namespace hopscotch::planner {

namespace {

using core::Reason;
using core::Refusal;

/// Farther than any jump of this robot; beyond it the terrain profile ends.
constexpr double kDistanceMax = 1.2;  // [m]
constexpr double kHeightMax = 0.8;    // [m]
/// A start whose feet are farther from the origin of S belongs to another target.
constexpr double kStartOffsetMax = 0.10;  // [m]
constexpr double kTiltMax = 0.7;          // [rad]
// Of the ground under the target sole.
constexpr double kHeightTolerance = 0.04;  // [m]
constexpr double kSoleInset = 0.01;        // from toe and heel, where maps blur edges [m]
constexpr double kSoleMiddle = 0.03;       // either side of the sole's centre [m]
constexpr double kEdgeNear = 0.02;         // before the heel at the target [m]
constexpr double kCutMax = 0.015;          // of ground beside a sole, for the sole's sake [m]

template <typename... Numbers>
std::string sentence(const char* format, Numbers... numbers) {
  char text[160];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

bool is_finite(const core::RobotState& state) {
  return state.p_WB.allFinite() && state.R_WB.allFinite() && state.v_WB.allFinite() &&
         state.w_WB.allFinite() && state.q.allFinite() && state.dq.allFinite();
}

double mean_of_legs(const core::JointVector& v, core::Joint joint) {
  return 0.5 * (v(core::joint_index(core::Leg::left, joint)) +
                v(core::joint_index(core::Leg::right, joint)));
}

LinkState projected(const core::RobotState& state, double heading) {
  const Eigen::Vector3d lateral(-std::sin(heading), std::cos(heading), 0.0);
  LinkState links;
  const double pitch = model::rpy_from_rotation(state.R_WB).y();
  const double rate = state.w_WB.dot(lateral);
  const auto chain = [](double trunk, const core::JointVector& v) {
    const double thigh = trunk + mean_of_legs(v, core::Joint::hip_pitch);
    const double shank = thigh + mean_of_legs(v, core::Joint::knee);
    return model::LinkArray<double>{0.0, shank, thigh, trunk};
  };
  links.pitch = chain(pitch, state.q);
  links.rate = chain(rate, state.dq);
  return links;
}

std::optional<Refusal> check_target(const PlannerConfig& config,
                                    const core::LandingTarget& target) {
  if (!std::isfinite(target.distance) || !std::isfinite(target.height) ||
      !std::isfinite(target.heading) || !target.p_WS.allFinite()) {
    return Refusal{Reason::target_malformed, "target or its frame is not a finite number"};
  }
  if (target.distance <= 0.0 || target.distance > kDistanceMax ||
      std::abs(target.height) > kHeightMax) {
    return Refusal{Reason::target_malformed,
                   sentence("distance %.3f m, height %.3f m, but 0 < distance <= %.1f and "
                            "|height| <= %.1f",
                            target.distance, target.height, kDistanceMax, kHeightMax)};
  }
  const SideTarget side = side_target(target);
  if (!(std::abs(side.lateral) <= config.lateral_max) || !(std::abs(side.yaw) <= config.yaw_max)) {
    return Refusal{Reason::target_malformed,
                   sentence("target is %.3f m beside the jump line and turned by %.3f rad; at most "
                            "%.3f m and %.3f rad",
                            side.lateral, side.yaw, config.lateral_max, config.yaw_max)};
  }
  return std::nullopt;
}

/// The ground that the profile knows under the target sole must be there, and at its height: what
/// rises at toe or heel is cut away from the terrain only as far as a map is uncertain.
std::optional<Refusal> check_support(const PlanarModel& model, const core::LandingTarget& target) {
  const double half = 0.5 * (model.robot.toe + model.robot.heel) - kSoleInset;
  for (int i = 0; i < core::TerrainProfile::kSamples; ++i) {
    const double from_sole = std::abs(core::TerrainProfile::x(i) - target.distance);
    const auto at = static_cast<std::size_t>(i);
    const double above = target.profile.upper[at] - target.height;
    if (from_sole <= half && std::isfinite(above) && above > kHeightTolerance) {
      return Refusal{Reason::target_malformed,
                     sentence("the ground rises %.3f m above the target sole, %.3f m from its "
                              "centre",
                              above, from_sole)};
    }
    const double below = target.height - target.profile.mean[at];
    if (from_sole <= kSoleMiddle && std::isfinite(below) && below > kHeightTolerance) {
      return Refusal{Reason::target_malformed,
                     sentence("the ground is %.3f m below the target sole, %.3f m from its centre",
                              below, from_sole)};
    }
  }
  return std::nullopt;
}

/// Ground that rises close to a sole is cut away where the smooth terrain has to be level, and no
/// knot of the plan would see it: a foot that leaves or comes down there would hit it.
std::optional<Refusal> check_way(const core::LandingTarget& target, const SmoothTerrain& terrain,
                                 double target_rear) {
  const double level = std::min(0.0, target.height) + kHeightTolerance;
  for (int i = 0; i < core::TerrainProfile::kSamples; ++i) {
    const double x = core::TerrainProfile::x(i);
    if (x <= 0.0 || x >= target_rear) continue;
    // Only what surely rises: what was not seen yet lies right before the toes.
    double surely = target.profile.lower[static_cast<std::size_t>(i)];
    // An edge may lie right before its next sample. Soles that come down keep 3.5 cm from edges.
    if (i > 0 && x > target_rear - kEdgeNear) {
      surely = std::max(surely, target.profile.lower[static_cast<std::size_t>(i - 1)]);
    }
    if (!(surely > level && surely - terrain.at(x).height > kCutMax)) continue;
    return Refusal{
        Reason::target_malformed,
        sentence("the ground at x = %.3f m has height %.3f m, too near to a sole for its "
                 "foot to pass",
                 x, surely)};
  }
  return std::nullopt;
}

/// Middle of the soles where they should be [m].
Eigen::Vector3d place_of(FeetPlace feet, const core::LandingTarget& target) {
  if (feet == FeetPlace::origin) return target.p_WS;
  return 0.5 * (target.X_WF[0].translation() + target.X_WF[1].translation());
}

std::optional<Refusal> check_start(const PlanarModel& model, const PlanRequest& request,
                                   FeetPlace feet) {
  const core::RobotState& start = request.start;
  if (!is_finite(start)) {
    return Refusal{Reason::bad_sensor_value, "start state is not a finite number"};
  }
  const std::array<Eigen::Isometry3d, core::kLegs> soles = model::sole_poses(model.robot, start);
  const Eigen::Vector3d middle = 0.5 * (soles[0].translation() + soles[1].translation());
  const double offset = (middle - place_of(feet, request.target)).norm();
  if (offset > kStartOffsetMax) {
    return Refusal{Reason::target_malformed,
                   sentence("soles are %.3f m from the %s of the jump, at most %.3f m", offset,
                            feet == FeetPlace::origin ? "origin" : "target", kStartOffsetMax)};
  }
  const Eigen::Vector3d rpy = model::rpy_from_rotation(start.R_WB);
  if (std::abs(rpy.x()) > kTiltMax || std::abs(rpy.y()) > kTiltMax) {
    return Refusal{Reason::plan_infeasible,
                   sentence("trunk leans by roll %.2f and pitch %.2f rad at the start, at most "
                            "%.2f rad",
                            rpy.x(), rpy.y(), kTiltMax)};
  }
  return std::nullopt;
}

}  // namespace

core::Result<PlanarTask> planar_task(const PlanarModel& model, const PlanRequest& request,
                                     FeetPlace feet) {
  const core::LandingTarget& target = request.target;
  if (std::optional<Refusal> refusal = check_target(model.config, target)) return *refusal;
  if (std::optional<Refusal> refusal = check_support(model, target)) return *refusal;
  if (std::optional<Refusal> refusal = check_start(model, request, feet)) return *refusal;
  const std::optional<model::StandPose> end = model::stand_pose(model.robot, request.final_posture);
  if (!end) return Refusal{Reason::out_of_reach, "the legs cannot reach the final posture"};
  const double half = 0.5 * (model.robot.toe + model.robot.heel);
  core::Result<SmoothTerrain> terrain = SmoothTerrain::from_profile(
      target.profile, SolePlace{-half, half, 0.0},
      SolePlace{target.distance - half, target.distance + half, target.height});
  if (!terrain) return terrain.error();
  if (std::optional<Refusal> refusal = check_way(target, *terrain, target.distance - half)) {
    return *refusal;
  }
  return PlanarTask{projected(request.start, target.heading),
                    end->pitch,
                    target.distance,
                    target.height,
                    model.config.clearance,
                    *terrain};
}

}  // namespace hopscotch::planner
