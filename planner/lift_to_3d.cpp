#include "planner/lift_to_3d.hpp"

#include <Eigen/Geometry>

#include "core/check.hpp"

namespace hopscotch::planner {

namespace {

using model::PlanarVector;

/// Both legs alike, zero yaw and roll.
core::JointVector both_legs(const model::PlanarJoints<double>& joints, double share) {
  core::JointVector out = core::JointVector::Zero();
  for (const core::Leg leg : core::kAllLegs) {
    out(core::joint_index(leg, core::Joint::hip_pitch)) = share * joints.hip;
    out(core::joint_index(leg, core::Joint::knee)) = share * joints.knee;
    out(core::joint_index(leg, core::Joint::ankle)) = share * joints.ankle;
  }
  return out;
}

/// Turns vectors and points of the plane into W.
struct Plane {
  Eigen::Vector3d origin;
  Eigen::Matrix3d R_WS;

  Plane(const Eigen::Vector3d& p_WS, double heading)
      : origin(p_WS),
        R_WS(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix()) {}
  [[nodiscard]] Eigen::Vector3d vector(const PlanarVector<double>& v) const {
    return R_WS * Eigen::Vector3d(v.x, 0.0, v.z);
  }
  [[nodiscard]] Eigen::Vector3d point(const PlanarVector<double>& p) const {
    return origin + vector(p);
  }
  /// A rate or moment about +y of S.
  [[nodiscard]] Eigen::Vector3d about(double size) const { return R_WS.col(1) * size; }
};

PlanarVector<double> sum(const PlanarVector<double>& a, const PlanarVector<double>& b) {
  return {a.x + b.x, a.z + b.z};
}

/// Half of the ground's wrench, moved from the ankle axis to the sole centre.
core::Wrench foot_wrench(const PlanarModel& model, const PlanarInstant& now, const Plane& plane) {
  constexpr double kShare = 1.0 / core::kLegs;
  const double moment = now.moment + model.dynamics.chain().sole_height * now.force.x +
                        model.robot.sole_centre() * now.force.z;
  return {kShare * plane.vector(now.force), kShare * plane.about(moment)};
}

core::JumpKnot lift_knot(const PlanarModel& model, const PlanarMotion& motion,
                         const PlanarKnot& from, double heading, const Plane& plane) {
  constexpr double kShare = 1.0 / core::kLegs;
  const PlanarInstant now = instant(model, motion, from, 0.0);
  const PlanarInstant middle = instant(model, motion, from, 0.5 * from.dt);
  const model::LinkArray<double>& a = now.links.pitch;
  const model::LinkArray<double>& w = now.links.rate;
  core::JumpKnot knot;
  knot.time = from.time;
  knot.dt = from.dt;
  knot.phase = from.phase;
  knot.contact.fill(from.phase != core::JumpPhase::flight);
  knot.p_WB = plane.point(sum(now.ankle, model.dynamics.trunk_origin(a)));
  knot.v_WB = plane.vector(sum(now.ankle_velocity, model.dynamics.trunk_origin_velocity(a, w)));
  knot.p_WG = plane.point(sum(now.ankle, model.dynamics.com(a)));
  knot.v_WG = plane.vector(sum(now.ankle_velocity, model.dynamics.com_velocity(a, w)));
  knot.rpy = {0.0, a[model::kTrunk], heading};
  knot.w_WB = plane.about(w[model::kTrunk]);
  knot.q = both_legs(model::joints_from_links(a), 1.0);
  knot.dq = both_legs(model::joints_from_links(w), 1.0);
  knot.tau = both_legs(middle.tau, kShare);
  if (from.phase != core::JumpPhase::flight) {
    knot.wrenches.fill(foot_wrench(model, middle, plane));
  }
  return knot;
}

}  // namespace

void lift_to_3d(const PlanarModel& model, const PlanarMotion& motion,
                const core::LandingTarget& target, core::JumpPlan& plan) {
  HOPSCOTCH_CHECK(motion.knots.size() <= core::JumpPlan::kMaxKnots);
  const Plane plane(target.p_WS, target.heading);
  plan.knot_count = motion.knots.size();
  for (std::size_t i = 0; i < motion.knots.size(); ++i) {
    plan.knots[i] = lift_knot(model, motion, motion.knots[i], target.heading, plane);
  }
  plan.liftoff_time = motion.liftoff_time;
  plan.touchdown_time = motion.touchdown_time;
  plan.duration = motion.knots.back().time;
}

}  // namespace hopscotch::planner
