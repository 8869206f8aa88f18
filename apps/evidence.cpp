#include "apps/evidence.hpp"

#include <algorithm>
#include <map>

#include "core/config_reader.hpp"
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
  if (msgs::read_run_log(folder.log(), handlers).events == 0) {
    throw core::ConfigError(folder.log().string() + ": is no LCM log: it holds no message");
  }
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

/// From the world as the controller took it to lie to the plant's. Place and heading drift, slowly,
/// and what the robot sees and plans drifts with them: that does no harm.
Eigen::Isometry3d drift(const core::RobotState& truth, const core::RobotState& believed) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  if (!believed.p_WB.allFinite()) return X;
  const double yaw =
      model::rpy_from_rotation(truth.R_WB).z() - model::rpy_from_rotation(believed.R_WB).z();
  X.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X.translation() = truth.p_WB - X.linear() * believed.p_WB;
  return X;
}

void move(const Eigen::Isometry3d& X, core::RobotState& state) {
  state.p_WB = X * state.p_WB;
  state.R_WB = X.linear() * state.R_WB;
  state.v_WB = X.linear() * state.v_WB;
  state.w_WB = X.linear() * state.w_WB;
}

void move(const Eigen::Isometry3d& X, core::JumpPlan& plan) {
  const double yaw = model::rpy_from_rotation(X.linear()).z();
  plan.target.p_WS = X * plan.target.p_WS;
  plan.target.heading += yaw;
  for (Eigen::Isometry3d& X_WF : plan.target.X_WF) X_WF = X * X_WF;
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    core::JumpKnot& knot = plan.knots[i];
    knot.rpy.z() += yaw;
    for (Eigen::Vector3d* p : {&knot.p_WB, &knot.p_WG}) *p = X * *p;
    for (Eigen::Vector3d* v : {&knot.v_WB, &knot.w_WB, &knot.v_WG}) *v = X.linear() * *v;
    for (core::Wrench& wrench : knot.wrenches) {
      wrench.force = X.linear() * wrench.force;
      wrench.moment = X.linear() * wrench.moment;
    }
  }
}

Sample sample_of(const RawRun& raw, const msgs::Status& status,
                 const model::RobotParameters& robot) {
  Sample sample;
  sample.time = status.control.stamp.seconds();
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

/// Of the plant against `robot.yaml`.
double mass_scale(const RunFolder& folder) {
  const auto scenario = core::ConfigReader::from_file(folder.config()).section("scenario");
  const auto plant = scenario.section_if("plant");
  return plant ? plant->number_or("mass_scale", 1.0) : 1.0;
}

}  // namespace

Evidence collect_evidence(const RunFolder& folder) {
  Evidence evidence;
  evidence.result = read_run_result(folder.result());
  evidence.robot = model::RobotParameters::load(folder.robot());
  evidence.mass = mass_scale(folder) * evidence.robot.total_mass();
  const RawRun raw = read(folder);
  evidence.has_truth = !raw.truth.empty();
  evidence.choice = raw.choice;
  if (raw.status.empty()) return evidence;
  for (std::size_t i = first_of_attempt(raw.status); i < raw.status.size(); ++i) {
    evidence.samples.push_back(sample_of(raw, raw.status[i], evidence.robot));
  }
  const auto plan = raw.plans.find(raw.status[last_of_plan(raw.status)].control.plan_id);
  if (plan != raw.plans.end()) evidence.plan = plan->second;
  const Sample& start = evidence.samples.front();
  const Eigen::Isometry3d X = drift(start.truth, start.believed);
  for (Sample& sample : evidence.samples) move(X, sample.believed);
  if (evidence.plan) move(X, *evidence.plan);
  return evidence;
}

}  // namespace hopscotch::apps
