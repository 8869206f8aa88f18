#include "apps/report_data.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/check.hpp"
#include "model/kinematics.hpp"
#include "model/motor.hpp"
#include "model/rigid_body.hpp"
#include "msgs/run_log.hpp"

namespace hopscotch::apps {

namespace {

using core::RobotPhase;

/// The log as it is, before anything is computed from it.
struct RawLog {
  std::vector<msgs::Truth> truth;
  std::vector<core::RobotState> states;
  std::vector<msgs::Status> status;
};

RawLog read_log(const RunFolder& folder, RunRecord& record) {
  RawLog raw;
  msgs::RunLogHandlers on;
  on.truth = [&](core::Stamp, const auto& m) { raw.truth.push_back(m.value); };
  on.state = [&](core::Stamp, const auto& m) { raw.states.push_back(m.value); };
  on.status = [&](core::Stamp, const auto& m) { raw.status.push_back(m.value); };
  on.plan = [&](core::Stamp, const auto& m) { record.plans.push_back(m.value); };
  on.target = [&](core::Stamp, const auto& m) { record.choices.push_back(m.value); };
  on.terrain = [&](core::Stamp, const auto& m) { record.terrains.push_back(m.value); };
  on.scene = [&](core::Stamp, const auto& m) { record.scene = m.value; };
  record.malformed = msgs::read_run_log(folder.log(), on).malformed;
  if (raw.truth.empty()) {
    for (const core::RobotState& state : raw.states) {
      msgs::Truth& truth = raw.truth.emplace_back();
      truth.stamp = state.stamp;
      truth.state = state;
      for (core::Wrench& wrench : truth.ground) wrench.force.setConstant(core::kNaN);
    }
  }
  return raw;
}

Moment make_moment(const RunRecord& record, const msgs::Truth& truth) {
  Moment moment;
  moment.time = record.seconds(truth.stamp);
  moment.state = truth.state;
  moment.p_WG = model::composite_body(record.robot, truth.state).p_WG;
  moment.pitch = model::rpy_from_rotation(truth.state.R_WB).y();
  moment.normal_force = 0.0;
  for (const core::Wrench& wrench : truth.ground) moment.normal_force += wrench.force.z();
  for (const core::Leg leg : core::kAllLegs) {
    MotorUse& use = moment.motors[core::index(leg)];
    const int first = core::leg_offset(leg);
    use.torque = model::motor_torques(truth.tau.segment<core::kJointsPerLeg>(first));
    use.speed = model::motor_speeds(truth.state.dq.segment<core::kJointsPerLeg>(first));
    use.power = use.torque.cwiseProduct(use.speed);
  }
  return moment;
}

/// What the plan wants at a time since its start; beyond its ends nothing.
void add_planned(const core::JumpPlan& plan, double plan_time, Moment& moment) {
  const auto end = plan.knots.begin() + static_cast<std::ptrdiff_t>(plan.knot_count);
  const auto next =
      std::upper_bound(plan.knots.begin(), end, plan_time,
                       [](double time, const core::JumpKnot& knot) { return time < knot.time; });
  if (next == plan.knots.begin() || next == end) return;
  const core::JumpKnot& before = *std::prev(next);
  const double share = (plan_time - before.time) / (next->time - before.time);
  moment.planned_pitch = before.rpy.y() + share * (next->rpy.y() - before.rpy.y());
  moment.planned_normal_force = 0.0;
  for (const core::Wrench& wrench : before.wrenches) {
    moment.planned_normal_force += wrench.force.z();
  }
}

void fill_moments(const RawLog& raw, RunRecord& record) {
  std::unordered_map<std::uint64_t, const core::JumpPlan*> plans;
  for (const core::JumpPlan& plan : record.plans) plans[plan.id] = &plan;
  auto status = raw.status.begin();
  record.moments.reserve(raw.truth.size());
  for (const msgs::Truth& truth : raw.truth) {
    Moment& moment = record.moments.emplace_back(make_moment(record, truth));
    while (status != raw.status.end() && std::next(status) != raw.status.end() &&
           std::next(status)->control.stamp <= truth.stamp) {
      ++status;
    }
    if (status == raw.status.end()) continue;
    const auto plan = plans.find(status->control.plan_id);
    const RobotPhase phase = status->control.phase;
    const bool jumping =
        core::is_pushing_off(phase) || phase == RobotPhase::flight || phase == RobotPhase::landing;
    if (jumping && plan != plans.end()) {
      add_planned(*plan->second, status->control.plan_time, moment);
    }
  }
}

void add_time(double time, double duration_ms, std::vector<TimedWork>& list) {
  if (std::isfinite(duration_ms)) list.push_back({time, duration_ms});
}

void fill_phases_and_times(const RawLog& raw, RunRecord& record) {
  for (const msgs::Status& status : raw.status) {
    const double time = record.seconds(status.control.stamp);
    const RobotPhase phase =
        core::is_pushing_off(status.control.phase) ? RobotPhase::takeoff : status.control.phase;
    if (record.phases.empty() || record.phases.back().phase != phase) {
      record.phases.push_back({phase, time, time});
      if (record.phases.size() > 1) record.phases[record.phases.size() - 2].end = time;
    }
    record.phases.back().end = time;
    add_time(time, status.times.plan_ms, record.planning);
    add_time(time, status.times.mpc_ms, record.balancing);
    add_time(time, status.times.perception_ms, record.perceiving);
    add_time(time, status.times.tick_ms, record.ticks);
  }
}

/// Time of the moment within [begin, end] whose CoM is highest (sign +1) or lowest (-1).
double extreme_time(const RunRecord& record, double begin, double end, double sign) {
  double best = -std::numeric_limits<double>::infinity();
  double time = core::kNaN;
  for (const Moment& moment : record.moments) {
    if (moment.time < begin || moment.time > end) continue;
    if (const double height = sign * moment.p_WG.z(); height > best) {
      best = height;
      time = moment.time;
    }
  }
  return time;
}

/// Plan ids by time, to find which plan a takeoff followed.
std::size_t plan_at(const RawLog& raw, const RunRecord& record, double time) {
  std::uint64_t id = 0;
  for (const msgs::Status& status : raw.status) {
    if (record.seconds(status.control.stamp) > time) break;
    id = status.control.plan_id;
  }
  const auto found = std::find_if(record.plans.begin(), record.plans.end(),
                                  [&](const core::JumpPlan& plan) { return plan.id == id; });
  return static_cast<std::size_t>(found - record.plans.begin());
}

void fill_jumps(const RawLog& raw, RunRecord& record) {
  for (std::size_t i = 0; i < record.phases.size(); ++i) {
    const PhaseSpan& takeoff = record.phases[i];
    if (takeoff.phase != RobotPhase::takeoff) continue;
    JumpRecord& jump = record.jumps.emplace_back();
    jump.index = static_cast<int>(record.jumps.size());
    jump.plan = plan_at(raw, record, takeoff.begin);
    jump.begin = takeoff.begin;
    jump.end = takeoff.end;
    auto& instants = jump.instants;
    instants[0] = extreme_time(record, takeoff.begin, takeoff.end, -1.0);
    if (i + 1 >= record.phases.size() || record.phases[i + 1].phase != RobotPhase::flight) continue;
    const PhaseSpan& flight = record.phases[i + 1];
    instants[1] = flight.begin;
    instants[2] = extreme_time(record, flight.begin, flight.end, 1.0);
    jump.end = flight.end;
    if (i + 2 >= record.phases.size() || record.phases[i + 2].phase != RobotPhase::landing)
      continue;
    instants[3] = flight.end;
    instants[4] = record.phases[i + 2].end;
    jump.end = record.phases[i + 2].end;
  }
}

}  // namespace

const Moment& RunRecord::moment_at(double time) const {
  HOPSCOTCH_CHECK(!moments.empty());
  const auto after = std::lower_bound(moments.begin(), moments.end(), time,
                                      [](const Moment& m, double t) { return m.time < t; });
  if (after == moments.end()) return moments.back();
  if (after == moments.begin()) return *after;
  const auto before = std::prev(after);
  return time - before->time < after->time - time ? *before : *after;
}

const core::JumpPlan* RunRecord::plan_of(const JumpRecord& jump) const {
  return jump.plan < plans.size() ? &plans[jump.plan] : nullptr;
}

RunRecord load_run(const RunFolder& folder) {
  RunRecord record;
  record.result = read_run_result(folder.result());
  record.robot = model::RobotParameters::load(folder.robot());
  const RawLog raw = read_log(folder, record);
  if (!raw.truth.empty()) record.origin = raw.truth.front().stamp;
  fill_moments(raw, record);
  fill_phases_and_times(raw, record);
  fill_jumps(raw, record);
  return record;
}

}  // namespace hopscotch::apps
