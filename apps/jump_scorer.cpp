#include "apps/jump_scorer.hpp"

#include <cmath>

#include "control/plan_follower.hpp"
#include "model/rigid_body.hpp"

namespace hopscotch::apps {

using core::RobotPhase;

namespace {

/// A sole that touches again so soon after lift-off has scraped along, not landed [s].
constexpr double kShortestFlight = 0.05;

/// After touchdown, in which the impact turns the trunk and the landing catches it [s].
constexpr double kPitchWatched = 0.15;

double pitch_of(const Eigen::Matrix3d& R_WB) {
  return std::atan2(-R_WB(2, 0), std::hypot(R_WB(0, 0), R_WB(1, 0)));
}

}  // namespace

JumpScorer::JumpScorer(const model::RobotParameters& robot, const sim::Terrain& terrain)
    : robot_(robot), terrain_(terrain) {}

void JumpScorer::update(const sim::PlantTruth& truth, const core::RobotState& used,
                        const core::ControlStatus& status, const core::JumpPlan& plan) {
  if (core::is_pushing_off(status.phase) && !core::is_pushing_off(phase_)) {
    judge(truth);
    begin(truth, plan);
  }
  // Flights that nobody planned, of a recovery hop or a fall, are no part of the jump.
  const bool unplanned = status.phase == RobotPhase::flight && status.plan_id == 0;
  phase_ = unplanned ? RobotPhase::recover : status.phase;
  if (open_) follow(truth, used);
}

void JumpScorer::replanned() {
  if (open_) ++jumps_.back().plan.replanned;
}

void JumpScorer::begin(const sim::PlantTruth& truth, const core::JumpPlan& plan) {
  takeoff_ = sim::takeoff_place(truth);
  peaks_ = {};
  liftoff_.reset();
  touchdown_.reset();
  plan_ = plan;
  open_ = true;
  JumpResult jump;
  jump.index = static_cast<int>(jumps_.size()) + 1;
  jump.start = truth.state.stamp.seconds();
  jump.target = {plan.target.distance, plan.target.height, plan.target.source};
  jump.plan.status = plan.status;
  jump.plan.iterations = plan.iterations;
  jump.plan.warm = plan.warm;
  jump.plan.duration = plan.duration;
  if (plan.certificate.count > 0) {
    jump.plan.binding_name = plan.certificate.binding().name;
    jump.plan.binding_margin = plan.certificate.binding().margin;
  }
  jumps_.push_back(jump);
}

void JumpScorer::follow(const sim::PlantTruth& truth, const core::RobotState& used) {
  JumpResult& jump = jumps_.back();
  peaks_.include(truth);
  jump.peak = {peaks_.torque_ratio, peaks_.speed_ratio, peaks_.power_ratio, peaks_.normal_force};
  const bool contact = truth.state.contact[0] || truth.state.contact[1];
  const bool leaving = core::is_pushing_off(phase_) || phase_ == RobotPhase::flight;
  // A crouch that starts fast may unload the soles: that is no lift-off.
  if (contact && core::is_pushing_off(phase_)) liftoff_.reset();
  if (!contact && !liftoff_ && leaving) {
    liftoff_ = truth.state.stamp;
    const Eigen::Vector3d v_WG = model::composite_body(robot_, truth.state).v_WG;
    jump.takeoff.speed_x =
        v_WG.x() * std::cos(takeoff_.heading) + v_WG.y() * std::sin(takeoff_.heading);
    jump.takeoff.speed_z = v_WG.z();
    jump.takeoff.estimate_error = (model::composite_body(robot_, used).v_WG - v_WG).norm();
  }
  if (touchdown_) compare_pitch(truth.state);
  if (!contact || !liftoff_ || touchdown_ || core::is_pushing_off(phase_)) return;
  const double flight = truth.state.stamp.since(*liftoff_);
  if (flight < kShortestFlight && phase_ == RobotPhase::flight) {
    liftoff_.reset();
  } else {
    touchdown_ = truth.state.stamp;
    jump.flight = flight;
    compare_pitch(truth.state);
  }
}

void JumpScorer::compare_pitch(const core::RobotState& truth) {
  const double since = truth.stamp.since(*touchdown_);
  if (since > kPitchWatched) return;
  const double planned = control::sample_plan(plan_, plan_.touchdown_time + since).rpy.y();
  const double error = std::abs(pitch_of(truth.R_WB) - planned);
  double& largest = jumps_.back().landing.pitch_error;
  if (!(largest >= error)) largest = error;
}

void JumpScorer::judge(const sim::PlantTruth& truth) {
  if (!open_) return;
  open_ = false;
  JumpResult& jump = jumps_.back();
  if (!touchdown_) {
    jump.outcome = JumpOutcome::aborted;
    return;
  }
  const sim::LandingVerdict verdict = sim::judge_landing(terrain_, robot_, takeoff_, truth);
  jump.landing.distance = verdict.distance;
  jump.landing.height = verdict.height;
  jump.landing.toe_margin = verdict.toe_margin;
  jump.landing.heel_margin = verdict.heel_margin;
  jump.outcome = verdict.over_edge ? JumpOutcome::missed : JumpOutcome::landed;
  if (verdict.over_edge) {
    jump.reason =
        core::Refusal{core::Reason::over_edge, "a toe or heel stands over an edge"}.text();
  }
}

void JumpScorer::fell(const core::Refusal& reason) {
  if (!open_) return;
  open_ = false;
  jumps_.back().outcome = JumpOutcome::fell;
  jumps_.back().reason = reason.text();
}

void JumpScorer::finish(const sim::PlantTruth& truth) {
  judge(truth);
}

}  // namespace hopscotch::apps
