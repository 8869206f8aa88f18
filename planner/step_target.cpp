#include "planner/step_target.hpp"

#include "model/kinematics.hpp"

namespace hopscotch::planner {

namespace {

/// A jump of the library that ends further from the place asked for is no answer [m].
constexpr double kPlaceTolerance = 1e-3;
constexpr double kEdgeAheadOfStart = 0.12;  // [m]
constexpr double kEdgeBeforeTarget = 0.12;  // [m]
constexpr double kLowered = 0.04;           // [m]
constexpr double kSinkingRate = 0.2;  // of hip and ankle; the knee bends twice as fast [rad/s]

}  // namespace

double default_edge(double distance, double height) {
  return height < 0.0 ? kEdgeAheadOfStart : distance - kEdgeBeforeTarget;
}

core::LandingTarget step_target(const StepRequest& request, const model::RobotParameters& robot) {
  core::LandingTarget target;
  target.p_WS = Eigen::Vector3d::Zero();
  target.heading = 0.0;
  target.distance = request.distance;
  target.height = request.height;
  target.margin = kPlaceTolerance;
  target.source = core::TargetSource::operator_override;
  const Eigen::Isometry3d X_WT =
      Eigen::Translation3d(request.distance, request.lateral, request.height) *
      Eigen::AngleAxisd(request.yaw, Eigen::Vector3d::UnitZ());
  for (const core::Leg leg : core::kAllLegs) {
    const double y = model::leg_poses(robot, leg, core::LegVector::Zero()).X_BF.translation().y();
    target.X_WF[core::index(leg)] = X_WT * Eigen::Translation3d(0.0, y, 0.0);
  }
  for (int i = 0; i < core::TerrainProfile::kSamples; ++i) {
    const std::size_t at = static_cast<std::size_t>(i);
    const double height = core::TerrainProfile::x(i) < request.edge ? 0.0 : request.height;
    target.profile.lower[at] = target.profile.mean[at] = target.profile.upper[at] = height;
    target.profile.state[at] = core::CellState::observed;
  }
  return target;
}

core::RobotState standing_state(const model::StandPose& pose) {
  core::RobotState state;
  state.p_WB = {pose.trunk_x, 0.0, pose.trunk_height};
  state.R_WB = model::rotation_from_rpy({0.0, pose.trunk_pitch, 0.0});
  state.v_WB.setZero();
  state.w_WB.setZero();
  state.q = pose.q;
  state.dq.setZero();
  state.contact.fill(true);
  return state;
}

std::string_view start_kind_name(StartKind kind) {
  switch (kind) {
    case StartKind::stand: return "stand";
    case StartKind::low: return "low";
    case StartKind::moving: return "moving";
  }
  return "";
}

std::optional<StartKind> start_kind_from(std::string_view name) {
  for (const StartKind kind : {StartKind::stand, StartKind::low, StartKind::moving}) {
    if (name == start_kind_name(kind)) return kind;
  }
  return std::nullopt;
}

std::optional<core::RobotState> start_state(StartKind kind, const model::RobotParameters& robot,
                                            const model::StandPosture& posture) {
  model::StandPosture from = posture;
  if (kind != StartKind::stand) from.com_height -= kLowered;
  const std::optional<model::StandPose> pose = model::stand_pose(robot, from);
  if (!pose) return std::nullopt;
  core::RobotState state = standing_state(*pose);
  if (kind != StartKind::moving) return state;
  // Feet stay flat and the trunk keeps its pitch: the rates of a leg add up to zero.
  for (const core::Leg leg : core::kAllLegs) {
    state.dq(core::joint_index(leg, core::Joint::hip_pitch)) = -kSinkingRate;
    state.dq(core::joint_index(leg, core::Joint::knee)) = 2.0 * kSinkingRate;
    state.dq(core::joint_index(leg, core::Joint::ankle)) = -kSinkingRate;
  }
  return state;
}

}  // namespace hopscotch::planner
