#include "apps/evidence.hpp"

#include <algorithm>
#include <map>

#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"
#include "msgs/run_log.hpp"

namespace hopscotch::apps {

namespace {

/// How long before the end is looked at when there was no jump [s].
constexpr double kLastSeconds = 3.0;

struct RawRun {
  std::vector<msgs::Truth> truth;
  std::vector<core::RobotState> believed;
  std::vector<msgs::Status> status;
  std::map<std::uint64_t, core::JumpPlan> plans;
  std::optional<core::TargetChoice> choice;
};

RawRun read(const RunFolder& folder) {
  RawRun raw;
  msgs::RunLogHandlers handlers;
  handlers.truth = [&](core::Stamp, const auto& message) { raw.truth.push_back(message.value); };
  handlers.state = [&](core::Stamp, const auto& message) { raw.believed.push_back(message.value); };
  handlers.status = [&](core::Stamp, const auto& message) { raw.status.push_back(message.value); };
  handlers.plan = [&](core::Stamp, const auto& message) {
    raw.plans[message.value.id] = message.value;
  };
  handlers.target = [&](core::Stamp, const auto& message) { raw.choice = message.value; };
  msgs::read_run_log(folder.log(), handlers);
  return raw;
}

/// Last status of the last jump's own plan. A recovery hop, which has none, belongs to the jump
/// that it follows.
std::size_t last_of_plan(const std::vector<msgs::Status>& status) {
  std::size_t last = status.size() - 1;
  const auto hops = [&](const core::ControlStatus& control) {
    const bool stands =
        control.phase == core::RobotPhase::stand || control.phase == core::RobotPhase::hold;
    return control.plan_id == 0 && !stands;
  };
  while (last > 0 && hops(status[last].control)) --last;
  return status[last].control.plan_id != 0 ? last : status.size() - 1;
}

/// First status of the last attempt: of the plan that was followed last, or of the last seconds.
std::size_t first_of_attempt(const std::vector<msgs::Status>& status) {
  std::size_t first = last_of_plan(status);
  const auto& last = status[first].control;
  const bool jumped = last.plan_id != 0;
  while (first > 0) {
    const auto& before = status[first - 1].control;
    const bool same = before.plan_id == last.plan_id;
    if (jumped ? !same : last.stamp.since(before.stamp) > kLastSeconds) break;
    --first;
  }
  return first;
}

/// Nearest by stamp; both lists are in order of time.
template <typename Value, typename StampOf>
const Value* nearest(const std::vector<Value>& values, core::Stamp stamp, StampOf stamp_of) {
  if (values.empty()) return nullptr;
  const auto after =
      std::lower_bound(values.begin(), values.end(), stamp,
                       [&](const Value& v, core::Stamp s) { return stamp_of(v) < s; });
  if (after == values.end()) return &values.back();
  if (after == values.begin()) return &*after;
  const auto before = std::prev(after);
  return stamp_of(*after).since(stamp) < stamp.since(stamp_of(*before)) ? &*after : &*before;
}

Sample sample_of(const RawRun& raw, const msgs::Status& status,
                 const model::RobotParameters& robot) {
  Sample sample;
  sample.time = status.control.stamp.since(raw.status.front().control.stamp);
  sample.status = status.control;
  sample.jump = status.jump;
  sample.deadline_misses = status.deadline_misses;
  const auto* believed = nearest(raw.believed, status.control.stamp,
                                 [](const core::RobotState& state) { return state.stamp; });
  if (believed != nullptr) sample.believed = *believed;
  const auto* truth = nearest(raw.truth, status.control.stamp,
                              [](const msgs::Truth& value) { return value.stamp; });
  sample.truth = truth != nullptr ? truth->state : sample.believed;
  if (truth != nullptr) {
    sample.ground = truth->ground;
    sample.tau = truth->tau;
  }
  sample.v_WG = model::composite_body(robot, sample.truth).v_WG;
  const auto soles = model::sole_poses(robot, sample.truth);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    const model::SoleTips tips = model::sole_tips(robot, soles[leg]);
    sample.toe[leg] = tips.toe;
    sample.heel[leg] = tips.heel;
    sample.load[leg] = sample.ground[leg].force.z();
  }
  return sample;
}

}  // namespace

Evidence collect_evidence(const RunFolder& folder) {
  Evidence evidence;
  evidence.result = read_run_result(folder.result());
  evidence.robot = model::RobotParameters::load(folder.robot());
  const RawRun raw = read(folder);
  evidence.has_truth = !raw.truth.empty();
  evidence.choice = raw.choice;
  if (raw.status.empty()) return evidence;
  for (std::size_t i = first_of_attempt(raw.status); i < raw.status.size(); ++i) {
    evidence.samples.push_back(sample_of(raw, raw.status[i], evidence.robot));
  }
  const auto plan = raw.plans.find(raw.status[last_of_plan(raw.status)].control.plan_id);
  if (plan != raw.plans.end()) evidence.plan = plan->second;
  return evidence;
}

}  // namespace hopscotch::apps
