#include "control/stand_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"

namespace hopscotch::control {

namespace {

constexpr double kStep = 0.03;  // [s]; the MPC goes in such steps and holds the last knot with it

Eigen::Vector3d mid_sole(const std::array<Eigen::Isometry3d, core::kLegs>& X_WF) {
  return 0.5 * (X_WF[0].translation() + X_WF[1].translation());
}

/// The knot at rest in the posture of `target`, on the present soles.
core::JumpKnot stand_knot(const model::RobotParameters& robot, const core::RobotState& state,
                          const StandTarget& target) {
  const std::array<Eigen::Isometry3d, core::kLegs> soles = model::sole_poses(robot, state);
  const Eigen::Vector3d forward = soles[0].linear().col(0) + soles[1].linear().col(0);
  const double yaw = std::atan2(forward.y(), forward.x());
  core::RobotState posed = state;
  posed.p_WB.setZero();
  posed.v_WB.setZero();
  posed.w_WB.setZero();
  posed.R_WB = model::rotation_from_rpy({0.0, target.pitch, yaw});
  posed.q = target.q;
  posed.dq.setZero();
  posed.p_WB = mid_sole(soles) - mid_sole(model::sole_poses(robot, posed));
  core::JumpKnot knot;
  knot.phase = core::JumpPhase::landing;
  knot.contact = {true, true};
  knot.p_WB = posed.p_WB;
  knot.rpy = {0.0, target.pitch, yaw};
  knot.v_WB.setZero();
  knot.w_WB.setZero();
  knot.p_WG = model::composite_body(robot, posed).p_WG;
  knot.v_WG.setZero();
  knot.q = target.q;
  knot.dq.setZero();
  knot.tau.setZero();
  for (core::Wrench& wrench : knot.wrenches) {
    wrench.force = {0.0, 0.0, 0.5 * model::kGravity * robot.total_mass()};
    wrench.moment.setZero();
  }
  return knot;
}

core::JumpKnot present_knot(const model::RobotParameters& robot, const core::RobotState& state) {
  const model::CompositeBody body = model::composite_body(robot, state);
  core::JumpKnot knot;
  knot.phase = core::JumpPhase::landing;
  knot.contact = {true, true};
  knot.p_WB = state.p_WB;
  knot.rpy = model::rpy_from_rotation(state.R_WB);
  knot.v_WB = state.v_WB;
  knot.w_WB = state.w_WB;
  knot.p_WG = body.p_WG;
  knot.v_WG = body.v_WG;
  knot.q = state.q;
  knot.dq = state.dq;
  knot.tau.setZero();
  return knot;
}

/// The cubic from a value and its rate to another value at rest: how much of each there is.
struct Easing {
  double begin, start, end;                 // shares of the values and of duration times rate
  double begin_rate, start_rate, end_rate;  // of their derivatives, per duration

  explicit Easing(double s)
      : begin(1.0 + s * s * (2.0 * s - 3.0)),
        start(s * (1.0 - s) * (1.0 - s)),
        end(s * s * (3.0 - 2.0 * s)),
        begin_rate(6.0 * s * (s - 1.0)),
        start_rate((1.0 - s) * (1.0 - 3.0 * s)),
        end_rate(6.0 * s * (1.0 - s)) {}
};

void ease(const Easing& e, double duration, const core::JumpKnot& from, core::JumpKnot& knot) {
  const core::JumpKnot to = knot;
  const auto blend = [&](const auto& value, const auto& rate, const auto& goal, auto& out,
                         auto& out_rate) {
    out = e.begin * value + e.start * duration * rate + e.end * goal;
    out_rate = (e.begin_rate * value + e.end_rate * goal) / duration + e.start_rate * rate;
  };
  blend(from.p_WB, from.v_WB, to.p_WB, knot.p_WB, knot.v_WB);
  blend(from.p_WG, from.v_WG, to.p_WG, knot.p_WG, knot.v_WG);
  blend(from.rpy, from.w_WB, to.rpy, knot.rpy, knot.w_WB);  // rates as if the tilt were small
  blend(from.q, from.dq, to.q, knot.q, knot.dq);
}

}  // namespace

void make_settle_plan(const model::RobotParameters& robot, const core::RobotState& state,
                      const StandTarget& target, double duration, core::JumpPlan& plan) {
  plan.id = 0;
  plan.stamp = state.stamp;
  plan.target = {};
  plan.target.X_WF = model::sole_poses(robot, state);
  plan.liftoff_time = 0.0;
  plan.touchdown_time = 0.0;
  plan.status = core::PlanStatus::solved;
  const core::JumpKnot from = present_knot(robot, state);
  core::JumpKnot to = stand_knot(robot, state, target);
  to.rpy.z() = from.rpy.z() + std::remainder(to.rpy.z() - from.rpy.z(), 2.0 * std::numbers::pi);
  const auto steps = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(duration / kStep)),
                                             1, core::JumpPlan::kMaxKnots - 1);
  plan.knot_count = steps + 1;
  plan.duration = duration;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(steps);
    core::JumpKnot& knot = plan.knots[i];
    knot = to;
    knot.time = s * duration;
    knot.dt = i < steps ? duration / static_cast<double>(steps) : 0.0;
    ease(Easing(s), duration, from, knot);
  }
}

}  // namespace hopscotch::control
