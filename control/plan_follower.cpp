#include "control/plan_follower.hpp"

#include <algorithm>

namespace hopscotch::control {

namespace {

/// Steps shorter than this are merged with the next: the QP gains nothing from them and its
/// linearisation loses conditioning.
constexpr double kShortestStep = 0.002;  // [s]

/// Weights of both ends' values and rates in a cubic Hermite polynomial.
struct HermiteWeights {
  double value_begin, rate_begin, value_end, rate_end;

  /// @param s Share of the step that has passed. @param dt Its length [s].
  HermiteWeights(double s, double dt)
      : value_begin(1.0 + s * s * (2.0 * s - 3.0)),
        rate_begin(dt * s * (1.0 - s) * (1.0 - s)),
        value_end(s * s * (3.0 - 2.0 * s)),
        rate_end(dt * s * s * (s - 1.0)) {}
};

/// The step whose mid-point lies on the other side of `time` than that of step `i`, within its
/// phase; `i` itself at the ends of the phase.
std::size_t neighbour_step(const core::JumpPlan& plan, std::size_t i, double time) {
  const core::JumpKnot& knot = plan.knots[i];
  const bool later = time > knot.time + 0.5 * knot.dt;
  if (!later && i == 0) return i;
  const std::size_t j = later ? i + 1 : i - 1;
  if (j + 1 >= plan.knot_count) return i;
  return plan.knots[j].phase == knot.phase && plan.knots[j].dt > kShortestStep ? j : i;
}

void sample_efforts(const core::JumpPlan& plan, std::size_t i, double time, core::JumpKnot& out) {
  const core::JumpKnot& a = plan.knots[i];
  const std::size_t j = neighbour_step(plan, i, time);
  const core::JumpKnot& b = plan.knots[j];
  const double mid_a = a.time + 0.5 * a.dt;
  const double mid_b = b.time + 0.5 * b.dt;
  const double s = i == j ? 0.0 : std::clamp((time - mid_a) / (mid_b - mid_a), 0.0, 1.0);
  out.tau = (1.0 - s) * a.tau + s * b.tau;
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    out.wrenches[leg].force = (1.0 - s) * a.wrenches[leg].force + s * b.wrenches[leg].force;
    out.wrenches[leg].moment = (1.0 - s) * a.wrenches[leg].moment + s * b.wrenches[leg].moment;
  }
}

}  // namespace

std::size_t knot_index(const core::JumpPlan& plan, double time) noexcept {
  const auto first = plan.knots.begin();
  const auto last = first + static_cast<std::ptrdiff_t>(plan.knot_count);
  const auto after = std::upper_bound(
      first, last, time, [](double t, const core::JumpKnot& knot) { return t < knot.time; });
  return after == first ? 0 : static_cast<std::size_t>(after - first) - 1;
}

namespace {

/// The knot at the end of step `i`, with the rates from before the ground stops the foot: the knot
/// at touchdown holds those from after it. Accelerations are constant within a step.
core::JumpKnot step_end(const core::JumpPlan& plan, std::size_t i) {
  const core::JumpKnot& begin = plan.knots[i];
  core::JumpKnot end = plan.knots[i + 1];
  if (begin.phase != core::JumpPhase::flight || end.phase != core::JumpPhase::landing) return end;
  const double per_step = 2.0 / begin.dt;
  end.dq = per_step * (end.q - begin.q) - begin.dq;
  end.v_WB = per_step * (end.p_WB - begin.p_WB) - begin.v_WB;
  return end;
}

}  // namespace

core::JumpKnot sample_plan(const core::JumpPlan& plan, double time) noexcept {
  const double t = std::clamp(time, 0.0, plan.duration);
  const std::size_t i = knot_index(plan, t);
  const core::JumpKnot& a = plan.knots[i];
  core::JumpKnot out = a;
  if (i + 1 >= plan.knot_count || a.dt <= 0.0) return out;
  const core::JumpKnot b = step_end(plan, i);
  const double s = std::clamp((t - a.time) / a.dt, 0.0, 1.0);
  out.time = t;
  out.dt = a.dt;
  const HermiteWeights w(s, a.dt);
  out.p_WB =
      w.value_begin * a.p_WB + w.rate_begin * a.v_WB + w.value_end * b.p_WB + w.rate_end * b.v_WB;
  out.p_WG =
      w.value_begin * a.p_WG + w.rate_begin * a.v_WG + w.value_end * b.p_WG + w.rate_end * b.v_WG;
  out.q = w.value_begin * a.q + w.rate_begin * a.dq + w.value_end * b.q + w.rate_end * b.dq;
  out.rpy = (1.0 - s) * a.rpy + s * b.rpy;
  out.v_WB = (1.0 - s) * a.v_WB + s * b.v_WB;
  out.w_WB = (1.0 - s) * a.w_WB + s * b.w_WB;
  out.v_WG = (1.0 - s) * a.v_WG + s * b.v_WG;
  out.dq = (1.0 - s) * a.dq + s * b.dq;
  sample_efforts(plan, i, t, out);
  return out;
}

namespace {

/// The plan's step length at `time`, cut where the phase ends.
double step_length(const core::JumpPlan& plan, double time) {
  const std::size_t i = knot_index(plan, time);
  double dt = plan.knots[i].dt;
  if (i + 1 >= plan.knot_count || dt <= 0.0) dt = plan.knots[plan.knot_count - 2].dt;
  for (const double boundary : {plan.liftoff_time, plan.touchdown_time}) {
    if (time < boundary - kShortestStep && time + dt > boundary - kShortestStep) {
      return boundary - time;
    }
  }
  return dt;
}

/// What a jump turns beyond its plan by a time of the plan: the yaw rate grows over the end of the
/// takeoff, stays in the air and is gone with the touchdown.
struct Turning {
  double angle = 0.0;  // [rad]
  double rate = 0.0;   // [rad/s]
};

Turning turning_at(const core::JumpPlan& plan, double time, double turn) {
  constexpr double kPush = 0.15;  // before lift-off [s]
  constexpr double kMost = 0.03;  // in one jump [rad]
  const double in_air = plan.touchdown_time - plan.liftoff_time;
  const double pushed = std::clamp(time - plan.liftoff_time + kPush, 0.0, kPush);
  const double flown = std::clamp(time - plan.liftoff_time, 0.0, in_air);
  const double rate = std::clamp(turn, -kMost, kMost) / (in_air + 0.5 * kPush);
  return {rate * (0.5 * pushed * pushed / kPush + flown), rate * pushed / kPush};
}

/// One knot of the window and the step that begins there.
void fill_knot(const core::JumpPlan& plan, double t, double dt, const PlanPlacement& placement,
               core::ReferenceKnot& knot) {
  const core::JumpKnot state = sample_plan(plan, t);
  const core::JumpKnot step = sample_plan(plan, t + 0.5 * dt);
  const bool landed = t >= plan.touchdown_time - kShortestStep;
  const PlanPlacement::Side& side = landed ? placement.landing : placement.takeoff;
  knot.dt = dt;
  knot.contact = step.contact;
  knot.p_WG = state.p_WG + side.shift;
  knot.rpy = state.rpy;
  knot.v_WG = state.v_WG;
  knot.w_WB = state.w_WB;
  const Turning turning = landed ? Turning{side.turn, 0.0} : turning_at(plan, t, side.turn);
  knot.rpy.z() += turning.angle;
  knot.w_WB.z() += turning.rate;
  knot.p_WF = side.soles;
  knot.wrenches = step.wrenches;
}

}  // namespace

void fill_reference(const core::JumpPlan& plan, double time, const PlanPlacement& placement,
                    core::ControlReference& reference) noexcept {
  double t = std::max(time, 0.0);
  for (std::size_t k = 0; k <= reference.horizon; ++k) {
    const double dt = step_length(plan, t);
    fill_knot(plan, t, dt, placement, reference.knots[k]);
    t += dt;
  }
}

void fill_reference_fixed(const core::JumpPlan& plan, double time, const PlanPlacement& placement,
                          double step, core::ControlReference& reference) noexcept {
  for (std::size_t k = 0; k <= reference.horizon; ++k) {
    fill_knot(plan, std::max(time, 0.0) + static_cast<double>(k) * step, step, placement,
              reference.knots[k]);
  }
}

core::RobotState extrapolate(const core::RobotState& state, double delay, const core::JumpKnot& now,
                             const core::JumpKnot& then) noexcept {
  core::RobotState later = state;
  later.stamp = state.stamp.after(delay);
  later.v_WB += then.v_WB - now.v_WB;
  later.w_WB += then.w_WB - now.w_WB;
  later.dq += then.dq - now.dq;
  later.p_WB += 0.5 * delay * (state.v_WB + later.v_WB);
  const Eigen::Vector3d turn = 0.5 * delay * (state.w_WB + later.w_WB);
  const double angle = turn.norm();
  if (angle > 0.0) later.R_WB = Eigen::AngleAxisd(angle, turn / angle) * state.R_WB;
  later.q += 0.5 * delay * (state.dq + later.dq);
  return later;
}

}  // namespace hopscotch::control
