#include "control/control_tick.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "control/disturbed_flight.hpp"
#include "control/torque_law.hpp"
#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "model/knot_state.hpp"
#include "model/rigid_body.hpp"

namespace hopscotch::control {

using core::RobotPhase;

namespace {

Eigen::Vector3d mid_sole(const std::array<Eigen::Isometry3d, core::kLegs>& X_WF) {
  return 0.5 * (X_WF[0].translation() + X_WF[1].translation());
}

/// Mid-point of the soles once they lie flat: shortly after touchdown a foot may still stand on its
/// heel or toe, and turns down about it.
Eigen::Vector3d mid_sole_laid(const model::RobotParameters& robot,
                              const std::array<Eigen::Isometry3d, core::kLegs>& X_WF) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& sole : X_WF) {
    const model::SoleTips tips = model::sole_tips(robot, sole);
    const Eigen::Vector3d along = tips.toe - tips.heel;
    const Eigen::Vector3d level =
        along.norm() * Eigen::Vector3d(along.x(), along.y(), 0.0).normalized();
    if (along.z() > 0.0) {
      middle += 0.5 * (tips.heel + 0.5 * level);
    } else {
      middle += 0.5 * (tips.toe - 0.5 * level);
    }
  }
  return middle;
}

/// Where both soles point, on the mean [rad].
double heading_of(const std::array<Eigen::Isometry3d, core::kLegs>& X_WF) {
  const Eigen::Vector3d ahead = X_WF[0].linear().col(0) + X_WF[1].linear().col(0);
  return std::atan2(ahead.y(), ahead.x());
}

std::array<Eigen::Vector3d, core::kLegs> centres(
    const std::array<Eigen::Isometry3d, core::kLegs>& X_WF) {
  return {X_WF[0].translation(), X_WF[1].translation()};
}

/// Mid-point of the soles of a knot as planned.
Eigen::Vector3d planned_mid_sole(const model::RobotParameters& robot, const core::JumpKnot& knot) {
  return mid_sole(model::sole_poses(robot, model::state_of(knot)));
}

double planned_heading(const model::RobotParameters& robot, const core::JumpKnot& knot) {
  return heading_of(model::sole_poses(robot, model::state_of(knot)));
}

double wrapped(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

}  // namespace

ControlTick::ControlTick(const ControlConfig& config, const model::RobotParameters& robot,
                         const StandTarget& stand)
    : config_(config), robot_(robot), supervisor_(config.supervisor, robot), stand_(stand) {}

double ControlTick::command_time(core::Stamp now) const noexcept {
  return now.since(start_);
}

void ControlTick::offer(const core::JumpPlan& plan) noexcept {
  next_ = plan;
  has_next_ = true;
}

void ControlTick::begin_next(const core::RobotState& state) noexcept {
  const double before = planned_heading(robot_, plan_.knots[plan_.knot_count - 1]);
  plan_ = next_;
  has_next_ = false;
  tilt_.begin(slope_ahead(plan_.target));
  start_ = state.stamp;
  const auto soles = model::sole_poses(robot_, state);
  // What the last landing turned too far is turned back, so that headings do not add up.
  const double turned = wrapped(planned_heading(robot_, plan_.knots[0]) - before);
  placement_.takeoff = {mid_sole(soles) - planned_mid_sole(robot_, plan_.knots[0]),
                        placement_.takeoff.turn - turned, centres(soles)};
  placement_.landing.shift = placement_.takeoff.shift;
  placement_.landing.turn = 0.0;
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    placement_.landing.soles[leg] = plan_.target.X_WF[leg].translation() + placement_.landing.shift;
  }
  replaced_knot_ = 0;
  supervisor_.begin_jump(plan_);
}

/// From the present motion to a stand on the present soles.
void ControlTick::settle(const core::RobotState& state, double duration) noexcept {
  // The ground's slope comes on top of any plan.
  const core::RobotState level = on_level_ground(robot_, state, tilt_.under());
  make_settle_plan(robot_, level, stand_, duration, plan_);
  start_ = state.stamp;
  placement_.takeoff =
      placement_.landing = {Eigen::Vector3d::Zero(), 0.0, centres(plan_.target.X_WF)};
  touchdown_ = state.stamp;
}

bool ControlTick::hold() noexcept {
  const bool pushing_off = core::is_pushing_off(phase());
  if (!supervisor_.hold()) return false;
  has_next_ = false;
  if (pushing_off && phase() == RobotPhase::hold) settle(state_, config_.settle_time);
  return true;
}

bool ControlTick::release() noexcept {
  const bool limp = core::is_limp(phase());
  if (!supervisor_.release(state_)) return false;
  if (limp) settle(state_, config_.settle_time);
  return true;
}

bool ControlTick::damp() noexcept {
  if (!supervisor_.damp()) return false;
  has_next_ = false;
  return true;
}

bool ControlTick::clear_fault() noexcept {
  return supervisor_.clear_fault();
}

void ControlTick::follow_feet(const core::RobotState& state) noexcept {
  if (state.stamp.since(touchdown_) > config_.anchor_time) return;
  const auto soles = model::sole_poses(robot_, state);
  const core::JumpKnot& last = plan_.knots[plan_.knot_count - 1];
  placement_.landing = {mid_sole_laid(robot_, soles) - planned_mid_sole(robot_, last),
                        wrapped(heading_of(soles) - planned_heading(robot_, last)), centres(soles)};
}

core::RobotState ControlTick::rest_state() const noexcept {
  const core::JumpKnot& last = plan_.knots[plan_.knot_count - 1];
  const Eigen::Vector3d middle = planned_mid_sole(robot_, last);
  const Eigen::AngleAxisd turn(placement_.landing.turn, Eigen::Vector3d::UnitZ());
  core::RobotState rest = state_;
  rest.p_WB = middle + turn * (last.p_WB - middle) + placement_.landing.shift;
  rest.R_WB = turn * model::rotation_from_rpy(last.rpy);
  rest.v_WB.setZero();
  rest.w_WB.setZero();
  rest.q = last.q;
  rest.dq.setZero();
  rest.contact = {true, true};
  return rest;
}

/// From a fall to a stand in such a time that the body sinks by `kCatchDepth` in it: the easing of
/// the settle plan sinks by 4/27 of its duration times the speed.
double ControlTick::catch_time(const core::RobotState& state) const noexcept {
  constexpr double kCatchDepth = 0.12;    // [m]
  constexpr double kCatchTimeMin = 0.25;  // [s]
  const double speed = std::max(-state.v_WB.z(), 1e-3);
  return std::clamp(27.0 / 4.0 * kCatchDepth / speed, kCatchTimeMin, config_.settle_time);
}

/// Touchdown sets the clock of the landing; a fall from a stand begins and ends with a plan of its
/// own.
void ControlTick::enter_phase(const core::RobotState& state) noexcept {
  phase_changed_ = phase() != last_phase_;
  const RobotPhase before = last_phase_;
  last_phase_ = phase();
  if (!phase_changed_) return;
  if (phase() == RobotPhase::flight && core::is_standing(before)) {
    if (!supervisor_.is_hopping()) settle(state, config_.settle_time);
  } else if (phase() == RobotPhase::landing && (is_falling_ || was_hopping_)) {
    settle(state, catch_time(state));
    impact_pending_ = true;
    shape_pending_ = false;
  } else if (phase() == RobotPhase::landing) {
    const bool follows = config_.ablation != core::Ablation::no_landing_plan;
    touchdown_ = state.stamp;
    tilt_.land();
    shape_pending_ = shape_landing(robot_, state, plan_);
    start_ = state.stamp.after(
        -((follows ? plan_.touchdown_time : plan_.duration) + config_.actuation_delay));
  }
  is_falling_ =
      phase() == RobotPhase::flight && core::is_standing(before) && !supervisor_.is_hopping();
}

/// The impact of a fall, or of a landing that is not as planned, is over: the feet have lost their
/// speed and taken some of the trunk's, so that the plan made before it would sink too far and
/// bounce.
void ControlTick::settle_again(const core::RobotState& state) noexcept {
  if (!impact_pending_ && !shape_pending_) return;
  if (state.stamp.since(touchdown_) < kImpactTime) return;
  const bool falling = impact_pending_;
  impact_pending_ = shape_pending_ = false;
  if (phase() != RobotPhase::landing) return;
  if (falling) {
    settle(state, catch_time(state));
  } else if (config_.ablation != core::Ablation::no_landing_plan) {
    shape_after_impact(robot_, state, command_time(state.stamp) - config_.actuation_delay, plan_);
  }
}

/// A body whose capture point has left the soles falls, wherever the soles push: they have to be
/// where it falls to.
void ControlTick::hop_if_it_must(const core::RobotState& state) noexcept {
  const RecoveryHopConfig& hop = config_.recovery_hop;
  const bool on_ground = phase() == RobotPhase::landing || core::is_standing(phase());
  const bool loaded = state.contact[0] || state.contact[1];
  if (!on_ground || supervisor_.is_hopping() || !loaded) return;
  if (state.stamp.since(touchdown_) < hop.wait || !must_hop(hop, robot_, state)) return;
  const core::RobotState level = on_level_ground(robot_, state, tilt_.under());
  if (!make_recovery_hop(hop, robot_, level, stand_, hop_plan_) || !supervisor_.hop()) return;
  has_next_ = false;
  tilt_.stay();
  plan_ = hop_plan_;
  start_ = state.stamp;
  placement_.takeoff = {Eigen::Vector3d::Zero(), 0.0, centres(model::sole_poses(robot_, state))};
  placement_.landing = {Eigen::Vector3d::Zero(), 0.0, centres(plan_.target.X_WF)};
}

void ControlTick::observe_drives(const core::SensorReadings& readings) noexcept {
  if (!core::is_standing(phase())) return;
  delays_.received(readings);
  if (const std::optional<double> delay = delays_.delay()) config_.actuation_delay = *delay;
}

core::JointCommand ControlTick::tick(const core::RobotState& state) noexcept {
  const double elapsed = started_ ? state.stamp.since(state_.stamp) : 0.0;
  const std::uint64_t stale_before = stale_ticks_;
  core::JointCommand command = next_command(state);
  unanswered_for_ = stale_ticks_ > stale_before ? unanswered_for_ + elapsed : 0.0;
  delays_.sent(command);
  return command;
}

/// How far the capture point, where the CoM would come to rest, is from the plan's, in the ground
/// plane [m].
double ControlTick::stray(const core::RobotState& state, double body_time) const noexcept {
  const core::JumpKnot planned = sample_plan(plan_, body_time);
  const model::CompositeBody body = model::composite_body(robot_, state);
  const double height =
      body.p_WG.z() - 0.5 * (placement_.takeoff.soles[0].z() + placement_.takeoff.soles[1].z());
  const double time = std::sqrt(std::max(height, 0.0) / model::kGravity);
  const Eigen::Vector3d off =
      body.p_WG - planned.p_WG - placement_.takeoff.shift + time * (body.v_WG - planned.v_WG);
  return off.head<2>().norm();
}

core::JointCommand ControlTick::next_command(const core::RobotState& state) noexcept {
  if (!started_) {
    tilt_.begin_on(robot_, state);
    settle(state, config_.settle_time);
  }
  const double elapsed = started_ ? state.stamp.since(state_.stamp) : 0.0;
  started_ = true;
  state_ = state;
  if (has_next_ && phase() == RobotPhase::stand) begin_next(state);
  const double body_time = command_time(state.stamp) - config_.actuation_delay;
  const bool crouching = phase() == RobotPhase::crouch;
  if (crouching && stray(state, body_time) > config_.supervisor.stray_max &&
      supervisor_.call_off()) {
    has_next_ = false;
    tilt_.stay();
    settle(state, config_.settle_time);
  }
  hop_if_it_must(state);
  supervisor_.update(state, plan_, command_time(state.stamp) - config_.actuation_delay);
  enter_phase(state);
  was_hopping_ = supervisor_.is_hopping();
  settle_again(state);
  const bool on_ground = phase() == RobotPhase::landing || core::is_standing(phase());
  if (on_ground && !was_hopping_) {
    follow_feet(state);
    tilt_.observe(robot_, state, status_.wrenches, elapsed);
  }

  core::JointCommand command;
  command.stamp = state.stamp;
  status_ = {.stamp = state.stamp,
             .phase = phase(),
             .plan_id = plan_.id,
             .plan_time = command_time(state.stamp) - config_.actuation_delay,
             .fault = supervisor_.fault(),
             .wrenches = {}};
  if (core::is_limp(phase())) {
    command.mode = core::DriveMode::damp;
    command.kd << config_.gains.kd, config_.gains.kd;
    return command;
  }
  command.mode = core::DriveMode::active;
  set_joint_targets(state, command);
  set_feed_forward(state, command);
  return command;
}

double ControlTick::joint_scale() const noexcept {
  if (phase() != RobotPhase::landing && !core::is_standing(phase())) return 1.0;
  const bool answered = unanswered_for_ <= config_.wrench_age_max;
  return answered ? config_.gains.compliant_scale : config_.gains.fallback_scale;
}

void ControlTick::set_joint_targets(const core::RobotState& state,
                                    core::JointCommand& command) const noexcept {
  double time = command_time(state.stamp);
  if (phase() == RobotPhase::flight) {
    time = is_falling_ ? plan_.duration : std::min(time, plan_.touchdown_time);
  }
  const core::JumpKnot planned = sample_plan(plan_, time);
  const double scale = joint_scale();
  command.q = planned.q;
  command.dq = planned.dq;
  // The ground is late: wait in the touchdown posture instead of yielding to a ground that is not
  // there.
  if (phase() == RobotPhase::flight && time >= plan_.touchdown_time) command.dq.setZero();
  command.kp << scale * config_.gains.kp, scale * config_.gains.kp;
  command.kd << scale * config_.gains.kd, scale * config_.gains.kd;
  if (phase() != RobotPhase::flight) {
    return lay_soles(robot_, planned.rpy.y(), tilt_.under(), command.q);
  }
  const double body_time = time - config_.actuation_delay;
  if (is_falling_) {
    keep_soles(config_.gains, state, sample_plan(plan_, body_time), command.q);
  } else {
    aim_legs(config_.gains, robot_, state, {plan_, body_time}, command.q);
  }
  const double flight = plan_.touchdown_time - plan_.liftoff_time;
  const GroundSlope slope =
      is_falling_ ? tilt_.under() : tilt_.in_flight((time - plan_.liftoff_time) / flight);
  lay_soles(robot_, model::rpy_from_rotation(state.R_WB).y(), slope, command.q);
}

ContactExpectation ControlTick::expected_contact() const noexcept {
  const double time = status_.plan_time;
  if (core::is_pushing_off(phase()) ||
      (supervisor_.is_hopping() && phase() == RobotPhase::recover)) {
    const double leave_time = config_.estimator.contact.leave_time;
    return time < plan_.liftoff_time - leave_time ? ContactExpectation::support
                                                  : ContactExpectation::leaving;
  }
  if (phase() != RobotPhase::flight) return ContactExpectation::support;
  const double flight = plan_.touchdown_time - plan_.liftoff_time;
  return time < plan_.liftoff_time + config_.supervisor.touchdown_from * flight
             ? ContactExpectation::airborne
             : ContactExpectation::touchdown;
}

bool ControlTick::answer_is_fresh() const noexcept {
  return answer_.status == MpcStatus::solved && answer_.stamp >= touchdown_ &&
         state_.stamp.since(answer_.stamp) <= config_.wrench_age_max;
}

MpcForm ControlTick::takeoff_form() const noexcept {
  const bool literal = config_.ablation == core::Ablation::paper_takeoff ||
                       config_.ablation == core::Ablation::srbd_only;
  return literal ? MpcForm::full : MpcForm::error_state;
}

/// The planned torques, and what the MPC wants to change of the planned wrenches.
void ControlTick::push_off(const core::RobotState& state, const core::JumpKnot& planned,
                           core::JointCommand& command) noexcept {
  command.tau = planned.tau;
  status_.wrenches = planned.wrenches;
  if (!answer_is_fresh() || answer_.form != MpcForm::error_state) {
    ++stale_ticks_;
    return;
  }
  if (answer_.stamp < replaced_) return;  // it corrects what the plan has taken in
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    status_.wrenches[leg].force += answer_.wrenches[leg].force - answer_.planned[leg].force;
    status_.wrenches[leg].moment += answer_.wrenches[leg].moment - answer_.planned[leg].moment;
  }
  bear_wrenches(state, planned.tau - contact_torques(robot_, state, planned.wrenches), command);
}

/// The MPC's wrenches and the legs' own weight; without the MPC what the plan would have.
void ControlTick::bear_load(const core::RobotState& state, const core::JumpKnot& planned,
                            core::JointCommand& command) noexcept {
  const bool answered = answer_is_fresh() && answer_.form == MpcForm::full;
  if (!answered) ++stale_ticks_;
  status_.wrenches = answered ? answer_.wrenches : planned.wrenches;
  bear_wrenches(state, leg_weight_torques(robot_, state), command);
}

/// Adds the torques for what the motors can hold of the chosen wrenches, next to `base` and the
/// joints' PD.
void ControlTick::bear_wrenches(const core::RobotState& state, const core::JointVector& base,
                                core::JointCommand& command) noexcept {
  const core::JointVector pd =
      command.kp.cwiseProduct(command.q - state.q) + command.kd.cwiseProduct(command.dq - state.dq);
  command.tau = base + held_torques(robot_, state, base + pd, status_.wrenches);
}

void ControlTick::answer(const MpcAnswer& answer) noexcept {
  if (answer.status == MpcStatus::solved) answer_ = answer;
}

void ControlTick::set_feed_forward(const core::RobotState& state,
                                   core::JointCommand& command) noexcept {
  const double time = command_time(state.stamp);
  const core::JumpKnot planned = sample_plan(plan_, time);
  switch (phase()) {
    case RobotPhase::crouch:
    case RobotPhase::takeoff:
      if (takeoff_form() == MpcForm::full) return bear_load(state, planned, command);
      return push_off(state, planned, command);
    case RobotPhase::flight:
      if (time <= plan_.touchdown_time) command.tau = planned.tau;
      return;
    case RobotPhase::landing:
    case RobotPhase::recover:
    case RobotPhase::hold:
    case RobotPhase::stand: return bear_load(state, planned, command);
    case RobotPhase::damp:
    case RobotPhase::fault: return;
  }
}

void ControlTick::question(MpcQuestion& out) const noexcept {
  const double delay = config_.mpc_delay + config_.actuation_delay;
  out.form = core::is_pushing_off(phase()) ? takeoff_form() : MpcForm::full;
  // The body runs `actuation_delay` behind the commands; it will have moved on by `delay`.
  const double time = command_time(state_.stamp) + config_.mpc_delay;
  const bool leaving = core::is_pushing_off(phase()) || supervisor_.is_hopping();
  const double phase_begin = leaving ? 0.0 : plan_.touchdown_time;
  out.state = extrapolate(state_, delay, sample_plan(plan_, std::max(time - delay, phase_begin)),
                          sample_plan(plan_, time));
  out.reference.stamp = out.state.stamp;
  if (config_.ablation == core::Ablation::fixed_frequency) {
    fill_reference_fixed(plan_, time, placement_, config_.fixed_step, out.reference);
  } else {
    fill_reference(plan_, time, placement_, out.reference);
  }
}

}  // namespace hopscotch::control
