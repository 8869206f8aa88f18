#include "planner/lift_to_3d.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/check.hpp"
#include "planner/side_lift.hpp"
#include "planner/straight_knot.hpp"

namespace hopscotch::planner {

namespace {

/// A target less beside the line or turned less is straight ahead: rounding [m], [rad].
constexpr double kStraight = 1e-6;

/// The trunk's turn in flight changes the momentum of the legs' swing a little.
constexpr int kMomentumPasses = 3;

/// Turns a knot from S into W.
void turn_into_world(const core::LandingTarget& target, core::JumpKnot& knot) {
  const Eigen::Matrix3d R_WS =
      Eigen::AngleAxisd(target.heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (Eigen::Vector3d* point : {&knot.p_WB, &knot.p_WG}) *point = target.p_WS + R_WS * *point;
  for (Eigen::Vector3d* vector : {&knot.v_WB, &knot.w_WB, &knot.v_WG}) *vector = R_WS * *vector;
  knot.rpy.z() += target.heading;
  for (core::Wrench& wrench : knot.wrenches) {
    wrench.force = R_WS * wrench.force;
    wrench.moment = R_WS * wrench.moment;
  }
}

core::JumpKnot lift_straight(const PlanarModel& model, const PlanarMotion& motion,
                             const PlanarKnot& from) {
  const PlanarInstant middle = instant(model, motion, from, 0.5 * from.dt);
  core::JumpKnot knot = straight_knot(model, instant(model, motion, from, 0.0));
  knot.tau = straight_torques(middle);
  if (from.phase != core::JumpPhase::flight) knot.wrenches.fill(straight_wrench(model, middle));
  return knot;
}

/// @return false if a leg cannot reach so far.
bool lift_aside(const PlanarModel& model, const PlanarMotion& motion, const SideTarget& side,
                core::JumpPlan& plan) {
  SideStep step(model, motion, side.lateral, side.yaw);
  const SideLift lift(model, motion, step);
  for (int pass = 0; pass < kMomentumPasses; ++pass) {
    const std::vector<double> momentum = lift.flight_momentum();
    if (momentum.empty()) return false;
    step.account_for(momentum);
  }
  for (std::size_t i = 0; i < motion.knots.size(); ++i) {
    if (!lift.lift(motion.knots[i], plan.knots[i])) return false;
  }
  return true;
}

}  // namespace

bool SideTarget::is_straight() const {
  return std::abs(lateral) < kStraight && std::abs(yaw) < kStraight;
}

SideTarget side_target(const core::LandingTarget& target) {
  const Eigen::Isometry3d X_SW = (Eigen::Translation3d(target.p_WS) *
                                  Eigen::AngleAxisd(target.heading, Eigen::Vector3d::UnitZ()))
                                     .inverse();
  const Eigen::Isometry3d left = X_SW * target.X_WF[0];
  const Eigen::Isometry3d right = X_SW * target.X_WF[1];
  return {0.5 * (left.translation().y() + right.translation().y()),
          std::atan2(left.linear()(1, 0), left.linear()(0, 0))};
}

bool lift_to_3d(const PlanarModel& model, const PlanarMotion& motion,
                const core::LandingTarget& target, core::JumpPlan& plan) {
  HOPSCOTCH_CHECK(motion.knots.size() <= core::JumpPlan::kMaxKnots);
  const SideTarget side = side_target(target);
  plan.knot_count = motion.knots.size();
  if (side.is_straight()) {
    for (std::size_t i = 0; i < motion.knots.size(); ++i) {
      plan.knots[i] = lift_straight(model, motion, motion.knots[i]);
    }
  } else if (!lift_aside(model, motion, side, plan)) {
    return false;
  }
  for (std::size_t i = 0; i < motion.knots.size(); ++i) {
    plan.knots[i].time = motion.knots[i].time;
    plan.knots[i].dt = motion.knots[i].dt;
    turn_into_world(target, plan.knots[i]);
  }
  plan.liftoff_time = motion.liftoff_time;
  plan.touchdown_time = motion.touchdown_time;
  plan.duration = motion.knots.back().time;
  return true;
}

}  // namespace hopscotch::planner
