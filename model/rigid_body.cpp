#include "model/rigid_body.hpp"

#include <Eigen/Geometry>
#include <array>

#include "model/kinematics.hpp"
#include "model/leg_mirror.hpp"

namespace hopscotch::model {

namespace {

/// One link as the sums over all links need it, everything in W.
struct MovingLink {
  double mass = 0.0;        // [kg]
  Eigen::Vector3d p_WC;     // link CoM [m]
  Eigen::Vector3d v_WC;     // [m/s]
  Eigen::Vector3d w_WL;     // [rad/s]
  Eigen::Matrix3d inertia;  // about the link CoM [kg·m^2]
};

constexpr std::size_t kLinks = 1 + core::kJoints;
using MovingLinks = std::array<MovingLink, kLinks>;

MovingLink moving_link(const LinkParameters& link, const Eigen::Isometry3d& X_WL,
                       const Eigen::Vector3d& v_WL, const Eigen::Vector3d& w_WL) {
  const Eigen::Vector3d p_LC_W = X_WL.linear() * link.com;
  return {link.mass, X_WL.translation() + p_LC_W, v_WL + w_WL.cross(p_LC_W), w_WL,
          X_WL.linear() * link.inertia * X_WL.linear().transpose()};
}

/// Walks down one leg and carries the velocity of each link's origin along.
void add_leg(const RobotParameters& robot, core::Leg leg, const core::RobotState& state,
             MovingLinks& links) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = state.R_WB;
  X_WB.translation() = state.p_WB;
  const int offset = core::leg_offset(leg);
  const LegPoses poses = leg_poses(robot, leg, state.q.segment<core::kJointsPerLeg>(offset));

  Eigen::Vector3d p_parent = state.p_WB;
  Eigen::Vector3d v = state.v_WB;
  Eigen::Vector3d w = state.w_WB;
  for (std::size_t i = 0; i < poses.X_BL.size(); ++i) {
    const Eigen::Isometry3d X_WL = X_WB * poses.X_BL[i];
    v += w.cross(X_WL.translation() - p_parent);
    w += X_WL.linear() * robot.joints[i].axis * state.dq(offset + static_cast<int>(i));
    p_parent = X_WL.translation();
    links[1 + static_cast<std::size_t>(offset) + i] =
        moving_link(leg_link(robot, leg, static_cast<core::Joint>(i)), X_WL, v, w);
  }
}

MovingLinks all_links(const RobotParameters& robot, const core::RobotState& state) {
  MovingLinks links;
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = state.R_WB;
  X_WB.translation() = state.p_WB;
  links[0] = moving_link(robot.trunk, X_WB, state.v_WB, state.w_WB);
  for (const core::Leg leg : core::kAllLegs) add_leg(robot, leg, state, links);
  return links;
}

/// Inertia of a point mass at `offset` from the reference point.
Eigen::Matrix3d point_inertia(double mass, const Eigen::Vector3d& offset) {
  return mass * (offset.squaredNorm() * Eigen::Matrix3d::Identity() - offset * offset.transpose());
}

}  // namespace

CompositeBody composite_body(const RobotParameters& robot, const core::RobotState& state) {
  const MovingLinks links = all_links(robot, state);
  CompositeBody body;
  body.mass = 0.0;
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();
  for (const MovingLink& link : links) {
    body.mass += link.mass;
    first_moment += link.mass * link.p_WC;
    linear_momentum += link.mass * link.v_WC;
  }
  body.p_WG = first_moment / body.mass;
  body.v_WG = linear_momentum / body.mass;

  body.inertia_W.setZero();
  body.momentum_W.setZero();
  for (const MovingLink& link : links) {
    const Eigen::Vector3d p_GC = link.p_WC - body.p_WG;
    body.inertia_W += link.inertia + point_inertia(link.mass, p_GC);
    body.momentum_W += link.inertia * link.w_WL + link.mass * p_GC.cross(link.v_WC - body.v_WG);
  }
  return body;
}

}  // namespace hopscotch::model
