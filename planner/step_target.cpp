#include "planner/step_target.hpp"

#include "model/kinematics.hpp"

namespace hopscotch::planner {

namespace {

constexpr double kEdgeAheadOfStart = 0.12;  // [m]
constexpr double kEdgeBeforeTarget = 0.12;  // [m]

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

}  // namespace hopscotch::planner
