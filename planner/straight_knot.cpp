#include "planner/straight_knot.hpp"

namespace hopscotch::planner {

namespace {

using model::PlanarVector;

constexpr double kShare = 1.0 / core::kLegs;

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

Eigen::Vector3d sum(const PlanarVector<double>& a, const PlanarVector<double>& b) {
  return {a.x + b.x, 0.0, a.z + b.z};
}

}  // namespace

core::JumpKnot straight_knot(const PlanarModel& model, const PlanarInstant& now) {
  const model::LinkArray<double>& a = now.links.pitch;
  const model::LinkArray<double>& w = now.links.rate;
  core::JumpKnot knot;
  knot.phase = now.phase;
  knot.contact.fill(now.phase != core::JumpPhase::flight);
  knot.p_WB = sum(now.ankle, model.dynamics.trunk_origin(a));
  knot.v_WB = sum(now.ankle_velocity, model.dynamics.trunk_origin_velocity(a, w));
  knot.p_WG = sum(now.ankle, model.dynamics.com(a));
  knot.v_WG = sum(now.ankle_velocity, model.dynamics.com_velocity(a, w));
  knot.rpy = {0.0, a[model::kTrunk], 0.0};
  knot.w_WB = {0.0, w[model::kTrunk], 0.0};
  knot.q = both_legs(model::joints_from_links(a), 1.0);
  knot.dq = both_legs(model::joints_from_links(w), 1.0);
  return knot;
}

core::Wrench straight_wrench(const PlanarModel& model, const PlanarInstant& now) {
  const double moment = now.moment + model.dynamics.chain().sole_height * now.force.x +
                        model.robot.sole_centre() * now.force.z;
  return {Eigen::Vector3d(kShare * now.force.x, 0.0, kShare * now.force.z),
          Eigen::Vector3d(0.0, kShare * moment, 0.0)};
}

core::JointVector straight_torques(const PlanarInstant& now) {
  return both_legs(now.tau, kShare);
}

}  // namespace hopscotch::planner
