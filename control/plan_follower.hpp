#pragma once

#include <array>

#include "core/control_reference.hpp"
#include "core/jump_plan.hpp"

namespace hopscotch::control {

/// The plan at a time between its knots: positions by cubic Hermite, rates linearly, torques and
/// wrenches linearly between the mid-points of the steps of one phase.
/// @param time Since the start of the plan; clamped to its duration [s].
/// @pre plan.knot_count >= 2. Real-time safe.
[[nodiscard]] core::JumpKnot sample_plan(const core::JumpPlan& plan, double time) noexcept;

/// The last knot at or before `time`. Real-time safe.
[[nodiscard]] std::size_t knot_index(const core::JumpPlan& plan, double time) noexcept;

/// How the plan is laid over what really happened, before touchdown and after it: what is added to
/// planned positions [m], how far to turn beside the plan [rad], where the soles are, in W [m].
struct PlanPlacement {
  struct Side {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    double turn = 0.0;
    std::array<Eigen::Vector3d, core::kLegs> soles{Eigen::Vector3d::Zero(),
                                                   Eigen::Vector3d::Zero()};
  };
  Side takeoff;
  Side landing;
};

/// The window of eq. (13): `horizon` steps from `time` on with the plan's own step lengths; a step
/// ends early where a phase does, so that contacts change only at knots. Past the end of the plan
/// the last knot is held with the last step length.
void fill_reference(const core::JumpPlan& plan, double time, const PlanPlacement& placement,
                    core::ControlReference& reference) noexcept;

/// The same with steps of one length, which the phases do not cut: the fixed frequency that the
/// paper compares with.
/// @param step > 0 [s].
void fill_reference_fixed(const core::JumpPlan& plan, double time, const PlanPlacement& placement,
                          double step, core::ControlReference& reference) noexcept;

/// The state `delay` later [s], its rates changing as the plan's do: what acts until then has been
/// sent already.
/// @param now, then The plan where the body is, and `delay` later.
[[nodiscard]] core::RobotState extrapolate(const core::RobotState& state, double delay,
                                           const core::JumpKnot& now,
                                           const core::JumpKnot& then) noexcept;

}  // namespace hopscotch::control
