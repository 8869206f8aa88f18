#include "sim/judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "model/kinematics.hpp"

namespace hopscotch::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

Vector3d middle_of_soles(const PlantTruth& truth) {
  return 0.5 * (truth.X_WF[0].translation() + truth.X_WF[1].translation());
}

struct SoleMargins {
  double toe;   // [m]
  double heel;  // [m]
};

SoleMargins sole_margins(const Terrain& terrain, const model::SoleTips& tips) {
  const Vector2d toe = tips.toe.head<2>();
  const Vector2d heel = tips.heel.head<2>();
  const double length = (toe - heel).norm();
  const Vector2d ahead = (toe - heel) / length;
  for (const Vector2d& from : {Vector2d(0.5 * (toe + heel)), heel, toe}) {
    const std::optional<double> front = support_ahead(terrain, from, ahead);
    const std::optional<double> rear = support_ahead(terrain, from, -ahead);
    if (!front || !rear) continue;
    return {.toe = *front - (toe - from).dot(ahead), .heel = *rear - (from - heel).dot(ahead)};
  }
  return {.toe = -length, .heel = -length};
}

}  // namespace

std::optional<std::string> fall_of(const PlantTruth& truth) {
  if (!truth.body_contacts.empty()) {
    const BodyContact& contact = truth.body_contacts.front();
    return contact.part + " touches " + contact.ground + " with " + rounded(contact.normal_force) +
           " N";
  }
  if (truth.foot_in_pit) return "a foot is on the floor of the pit";
  const double tilt = std::acos(std::clamp(truth.state.R_WB(2, 2), -1.0, 1.0));
  if (tilt > kTiltOfFall) return "the trunk is tilted by " + rounded(tilt) + " rad";
  const double lower_sole =
      std::min(truth.X_WF[0].translation().z(), truth.X_WF[1].translation().z());
  const double height = truth.state.p_WB.z() - lower_sole;
  if (height < kTrunkHeightOfFall) {
    return "the trunk is only " + rounded(height) + " m above the lower sole";
  }
  return std::nullopt;
}

TakeoffPlace takeoff_place(const PlantTruth& truth) {
  return {.p_WS = middle_of_soles(truth),
          .heading = model::rpy_from_rotation(truth.state.R_WB).z()};
}

LandingVerdict judge_landing(const Terrain& terrain, const model::RobotParameters& robot,
                             const TakeoffPlace& from, const PlantTruth& rest) {
  const Vector3d flown = middle_of_soles(rest) - from.p_WS;
  const double c = std::cos(from.heading);
  const double s = std::sin(from.heading);
  LandingVerdict verdict{.distance = c * flown.x() + s * flown.y(),
                         .lateral = c * flown.y() - s * flown.x(),
                         .height = flown.z(),
                         .toe_margin = std::numeric_limits<double>::infinity(),
                         .heel_margin = std::numeric_limits<double>::infinity(),
                         .over_edge = false};
  for (const Eigen::Isometry3d& X_WF : rest.X_WF) {
    const SoleMargins margins = sole_margins(terrain, model::sole_tips(robot, X_WF));
    verdict.toe_margin = std::min(verdict.toe_margin, margins.toe);
    verdict.heel_margin = std::min(verdict.heel_margin, margins.heel);
  }
  verdict.over_edge = std::min(verdict.toe_margin, verdict.heel_margin) < -kOverEdge;
  return verdict;
}

double heel_progress(const model::RobotParameters& robot, const PlantTruth& truth, double heading) {
  const Vector2d ahead(std::cos(heading), std::sin(heading));
  double rear = std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& X_WF : truth.X_WF) {
    const Vector2d heel = model::sole_tips(robot, X_WF).heel.head<2>();
    rear = std::min(rear, heel.dot(ahead));
  }
  return rear;
}

void LoadPeaks::include(const PlantTruth& truth) {
  for (const model::MotorLoad& load : truth.load) {
    torque_ratio = std::max(torque_ratio, load.torque_ratio.maxCoeff());
    speed_ratio = std::max(speed_ratio, load.speed_ratio.maxCoeff());
    power_ratio = std::max(power_ratio, load.power_ratio.maxCoeff());
  }
  braking_power = std::max(braking_power, -truth.motor_power.minCoeff());
  normal_force = std::max(normal_force, truth.ground[0].force.z() + truth.ground[1].force.z());
}

}  // namespace hopscotch::sim
