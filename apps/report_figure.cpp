#include "apps/report_figure.hpp"

#include "model/kinematics.hpp"

namespace hopscotch::apps {

namespace {

Eigen::Vector2d side(const Eigen::Vector3d& p_W) {
  return {p_W.x(), p_W.z()};
}

}  // namespace

StickFigure stick_figure(const model::RobotParameters& robot, const core::RobotState& state) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = state.R_WB;
  X_WB.translation() = state.p_WB;
  StickFigure figure;
  const Eigen::Vector3d half = 0.5 * robot.trunk_box;
  figure.trunk = {side(X_WB * Eigen::Vector3d(-half.x(), 0.0, -half.z())),
                  side(X_WB * Eigen::Vector3d(half.x(), 0.0, -half.z())),
                  side(X_WB * Eigen::Vector3d(half.x(), 0.0, half.z())),
                  side(X_WB * Eigen::Vector3d(-half.x(), 0.0, half.z()))};
  for (const core::Leg leg : core::kAllLegs) {
    const core::LegVector q = state.q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
    const model::LegPoses poses = model::leg_poses(robot, leg, q);
    const auto axis = [&](core::Joint joint) {
      return side(X_WB * Eigen::Vector3d(poses.X_BL[core::index(joint)].translation()));
    };
    const model::SoleTips tips = model::sole_tips(robot, X_WB * poses.X_BF);
    figure.legs[core::index(leg)] = {axis(core::Joint::hip_pitch), axis(core::Joint::knee),
                                     axis(core::Joint::ankle), side(tips.toe), side(tips.heel)};
  }
  return figure;
}

}  // namespace hopscotch::apps
