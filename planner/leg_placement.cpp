#include "planner/leg_placement.hpp"

#include <Eigen/LU>

#include "model/kinematics.hpp"

namespace hopscotch::planner {

namespace {

using Square = Eigen::Matrix<double, core::kJointsPerLeg, core::kJointsPerLeg>;

constexpr int kIterationsMax = 12;
constexpr double kPlaced = 1e-10;  // [m], [rad]

/// Three rows of place and two of the sole's long axis, each in axes of B.
struct LegProblem {
  core::LegVector residual;
  Square slope;
};

LegProblem leg_problem(const model::RobotParameters& robot, core::Leg leg, const core::LegVector& q,
                       const Eigen::Isometry3d& X_BF) {
  const Eigen::Isometry3d now = model::leg_poses(robot, leg, q).X_BF;
  const Eigen::Matrix<double, 6, core::kJointsPerLeg> jacobian =
      model::sole_jacobian(robot, leg, q);
  const Eigen::Vector3d turn = now.linear().col(0).cross(X_BF.linear().col(0));
  LegProblem problem;
  problem.residual.head<3>() = X_BF.translation() - now.translation();
  problem.slope.topRows<3>() = jacobian.topRows<3>();
  for (int axis = 1; axis <= 2; ++axis) {
    const Eigen::Vector3d about = now.linear().col(axis);
    problem.residual(2 + axis) = about.dot(turn);
    problem.slope.row(2 + axis) = about.transpose() * jacobian.bottomRows<3>();
  }
  return problem;
}

bool place_leg(const model::RobotParameters& robot, core::Leg leg, const SoleMotion& sole,
               core::JumpKnot& knot) {
  const Eigen::Matrix3d R_WB = model::rotation_from_rpy(knot.rpy);
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = R_WB;
  X_WB.translation() = knot.p_WB;
  const Eigen::Isometry3d X_BF = X_WB.inverse() * sole.X_WF;
  core::LegVector q = knot.q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
  LegProblem problem = leg_problem(robot, leg, q, X_BF);
  for (int i = 0; i < kIterationsMax && problem.residual.cwiseAbs().maxCoeff() > kPlaced; ++i) {
    q += problem.slope.partialPivLu().solve(problem.residual);
    problem = leg_problem(robot, leg, q, X_BF);
  }
  if (!(problem.residual.cwiseAbs().maxCoeff() <= kPlaced)) return false;

  const Eigen::Isometry3d now = model::leg_poses(robot, leg, q).X_BF;
  const Eigen::Vector3d arm = sole.X_WF.translation() - knot.p_WB;
  const Eigen::Vector3d v_B = R_WB.transpose() * (sole.v_WF - knot.v_WB - knot.w_WB.cross(arm));
  const Eigen::Vector3d w_B = R_WB.transpose() * (sole.w_WF - knot.w_WB);
  core::LegVector rate;
  rate << v_B, now.linear().col(1).dot(w_B), now.linear().col(2).dot(w_B);
  knot.q.segment<core::kJointsPerLeg>(core::leg_offset(leg)) = q;
  knot.dq.segment<core::kJointsPerLeg>(core::leg_offset(leg)) =
      problem.slope.partialPivLu().solve(rate);
  return true;
}

}  // namespace

bool place_legs(const model::RobotParameters& robot,
                const std::array<SoleMotion, core::kLegs>& soles, core::JumpKnot& knot) {
  for (const core::Leg leg : core::kAllLegs) {
    if (!place_leg(robot, leg, soles[core::index(leg)], knot)) return false;
  }
  return knot.q.allFinite() && knot.dq.allFinite();
}

}  // namespace hopscotch::planner
