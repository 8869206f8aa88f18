#pragma once

#include "core/jump_plan.hpp"
#include "core/robot_state.hpp"

namespace hopscotch::control::testing {

/// The robot at rest on both feet.
inline core::RobotState standing_robot() {
  core::RobotState state;
  state.p_WB = {0.0, 0.0, 0.5481};
  state.R_WB.setIdentity();
  state.v_WB.setZero();
  state.w_WB.setZero();
  state.q << 0, 0, 0.7854, -1.5708, 0.7854, 0, 0, 0.7854, -1.5708, 0.7854;
  state.dq.setZero();
  state.contact = {true, true};
  return state;
}

/// A plan with the shape of a jump and simple numbers: 0.2 s takeoff in steps of 20 ms, 0.1 s
/// flight in steps of 25 ms, 0.12 s landing in steps of 30 ms. Everything scalar moves with
/// constant acceleration from rest, so that interpolation can be checked in closed form.
inline core::JumpPlan jump_shaped_plan(const core::JointVector& q0) {
  constexpr double kAcceleration = 2.0;
  core::JumpPlan plan;
  plan.id = 1;
  plan.status = core::PlanStatus::solved;
  plan.liftoff_time = 0.2;
  plan.touchdown_time = 0.3;
  plan.duration = 0.42;
  const auto add = [&](double time, double dt, core::JumpPhase phase) {
    core::JumpKnot& knot = plan.knots[plan.knot_count++];
    const double move = 0.5 * kAcceleration * time * time;
    const double rate = kAcceleration * time;
    knot.time = time;
    knot.dt = dt;
    knot.phase = phase;
    const bool contact = phase != core::JumpPhase::flight;
    knot.contact = {contact, contact};
    knot.p_WB = {move, 0.0, 0.55};
    knot.rpy = {0.0, 0.1 * time, 0.0};
    knot.v_WB = {rate, 0.0, 0.0};
    knot.w_WB = {0.0, 0.1, 0.0};
    knot.p_WG = {move, 0.0, 0.40};
    knot.v_WG = {rate, 0.0, 0.0};
    knot.q = q0 + core::JointVector::Constant(0.01 * move);
    knot.dq = core::JointVector::Constant(0.01 * rate);
    knot.tau = core::JointVector::Constant(contact ? 10.0 * (time + 0.5 * dt) : 0.0);
    for (core::Wrench& wrench : knot.wrenches) {
      wrench.force = {0.0, 0.0, contact ? 70.0 : 0.0};
    }
  };
  for (int k = 0; k < 10; ++k) add(0.02 * k, 0.02, core::JumpPhase::takeoff);
  for (int k = 0; k < 4; ++k) add(0.2 + 0.025 * k, 0.025, core::JumpPhase::flight);
  for (int k = 0; k < 4; ++k) add(0.3 + 0.03 * k, 0.03, core::JumpPhase::landing);
  add(0.42, 0.0, core::JumpPhase::landing);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    plan.target.X_WF[leg].translation() = Eigen::Vector3d(0.4, leg == 0 ? 0.1 : -0.1, 0.0);
  }
  return plan;
}

}  // namespace hopscotch::control::testing
