#include "apps/lockstep_run.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/config_reader.hpp"
#include "model/kinematics.hpp"
#include "model/stand_posture.hpp"
#include "sim/judge.hpp"
#include "sim/terrain_builder.hpp"

namespace hopscotch::apps {

using core::Reason;
using core::RobotPhase;

namespace {

/// After a fault the robot is watched for so long before it is said whether it fell [s].
constexpr double kWatchAfterFault = 1.5;

sim::PlantOptions plant_options(const RunRequest& request) {
  const std::optional<model::StandPose> pose =
      model::stand_pose(request.robot, request.config.stand_posture);
  if (!pose) throw core::ConfigError("stand_posture: " + request.robot.name + " cannot stand so");
  return {.scenario = request.scenario,
          .robot = request.plant_robot,
          .posture = {.q = pose->q, .trunk_pitch = pose->trunk_pitch},
          .variation = {},
          .seed = request.seed};
}

Mission mission_of(const RunRequest& request) {
  Mission mission;
  if (request.scenario.goal.x) mission.goal_x = *request.scenario.goal.x;
  if (request.scenario.goal.jumps) mission.jumps = *request.scenario.goal.jumps;
  const bool shorter = mission.jumps == 0 || request.jumps_max < mission.jumps;
  if (request.jumps_max > 0 && shorter) mission.jumps = request.jumps_max;
  mission.targets = request.scenario.targets;
  const sim::StartPlace& start = request.scenario.start;
  const double ground =
      request.scenario.true_terrain().top_at({start.x, 0.0}).value_or(0.0);  // checked on loading
  mission.start = {{start.x, 0.0, ground + start.drop}, start.yaw};
  return mission;
}

ProgramConfig config_of(const RunRequest& request) {
  ProgramConfig config = request.config;
  config.control.ablation = request.ablation;
  return config;
}

std::optional<core::JumpPhase> jump_phase(RobotPhase phase) {
  switch (phase) {
    case RobotPhase::crouch:
    case RobotPhase::takeoff: return core::JumpPhase::takeoff;
    case RobotPhase::flight: return core::JumpPhase::flight;
    case RobotPhase::landing:
    case RobotPhase::recover: return core::JumpPhase::landing;
    case RobotPhase::stand:
    case RobotPhase::hold:
    case RobotPhase::damp:
    case RobotPhase::fault: return std::nullopt;
  }
  return std::nullopt;
}

Reason fall_reason(RobotPhase phase) {
  switch (phase) {
    case RobotPhase::crouch:
    case RobotPhase::takeoff: return Reason::fell_in_takeoff;
    case RobotPhase::flight: return Reason::fell_in_flight;
    case RobotPhase::landing:
    case RobotPhase::recover: return Reason::fell_in_landing;
    case RobotPhase::stand:
    case RobotPhase::hold:
    case RobotPhase::damp:
    case RobotPhase::fault: return Reason::fell_standing;
  }
  return Reason::fell_standing;
}

}  // namespace

DrawnElsewhere::DrawnElsewhere(sim::SimCamera& camera)
    : camera_(camera),
      drawing_({.name = "camera", .latency = 0.0, .threaded = true, .thread = {}},
               [this](const sim::SimCamera::Exposure& exposure, core::DepthFrame& frame) {
                 frame = camera_.draw(exposure);
               }) {}

std::optional<core::DepthFrame> DrawnElsewhere::poll(core::Stamp now) {
  std::optional<core::DepthFrame> arrived;
  static_cast<void>(drawing_.made());
  if (core::DepthFrame* const frame = drawing_.take(now)) arrived = std::move(*frame);
  if (!drawing_.vacant()) return arrived;
  if (const std::optional<sim::SimCamera::Exposure> exposure = camera_.due(now)) {
    drawing_.question() = *exposure;
    drawing_.ask(now);
  }
  return arrived;
}

LockstepRun::LockstepRun(const RunRequest& request)
    : request_(request),
      plant_(plant_options(request)),
      camera_(request.scenario.camera, request.plant_robot, request.scenario.seen, request.seed),
      pipeline_(config_of(request), request.robot, mission_of(request), oracle(),
                request.threading),
      scorer_(request.plant_robot, request.scenario.true_terrain()) {
  if (request.threading == Threading::threads) drawn_elsewhere_.emplace(camera_);
  result_.scenario = request.scenario.name;
  result_.seed = request.seed;
  result_.perception = request.eyes == Eyes::camera ? "camera" : "truth";
  result_.state = request.state == StateSource::truth ? "truth" : "estimate";
  result_.position_error = 0.0;
  result_.pitch_error = 0.0;
}

/// What perfect perception would show: the seen terrain around where the robot really is, laid
/// around where it believes to be.
Pipeline::TerrainOracle LockstepRun::oracle() const {
  if (request_.eyes == Eyes::camera) return {};
  return [this](const core::RobotState& believed) -> MapDrawing {
    const double yaw = model::rpy_from_rotation(believed.R_WB).z() -
                       model::rpy_from_rotation(true_state_.R_WB).z();
    const sim::Terrain around = sim::moved(request_.scenario.seen, true_state_.p_WB.head<2>(), yaw,
                                           believed.p_WB - true_state_.p_WB);
    return [around, centre = Eigen::Vector2d(believed.p_WB.head<2>()), stamp = believed.stamp] {
      return sim::seen_terrain_map(around, centre, stamp);
    };
  };
}

bool LockstepRun::step(const std::function<void(const TickRecord&)>& observe) {
  if (ended_) return false;
  const core::SensorReadings readings = plant_.exchange(command_);
  const sim::PlantTruth truth = plant_.truth();
  true_state_ = truth.state;
  // Who knows the terrain looks at nothing: drawing frames would be most of the time.
  if (request_.eyes == Eyes::camera) camera_.expose(truth.state);
  core::DepthSource& camera =
      drawn_elsewhere_ ? static_cast<core::DepthSource&>(*drawn_elsewhere_) : camera_;
  command_ = request_.state == StateSource::truth ? pipeline_.tick(truth.state, camera)
                                                  : pipeline_.tick(readings, camera);
  plant_.notify_phase(jump_phase(pipeline_.status().phase));
  scorer_.update(truth, pipeline_.state(), pipeline_.status(), pipeline_.plan());
  if (pipeline_.events().replanned) scorer_.replanned();
  collect_times();
  compare(truth);
  if (observe) {
    observe({readings, pipeline_.state(), command_, truth, pipeline_.status(), pipeline_.events(),
             pipeline_.plan(), static_cast<int>(scorer_.jumps().size()), pipeline_.held()});
  }
  judge(truth);
  return !ended_;
}

void LockstepRun::collect_times() {
  const PipelineEvents& events = pipeline_.events();
  if (events.planning_ms) samples_.plan_ms.push_back(*events.planning_ms);
  if (events.replanning_ms) samples_.replan_ms.push_back(*events.replanning_ms);
  if (events.mpc_ms) samples_.mpc_ms.push_back(*events.mpc_ms);
  if (events.perception_ms) samples_.perception_ms.push_back(*events.perception_ms);
  if (events.estimator_ms) samples_.estimator_ms.push_back(*events.estimator_ms);
  samples_.tick_ms.push_back(events.tick_ms);
  samples_.allocations += events.allocations;
}

/// The largest errors of the state that was used. A fall is no measure of an estimator.
void LockstepRun::compare(const sim::PlantTruth& truth) {
  const core::RobotState& used = pipeline_.state();
  const double pitch =
      model::rpy_from_rotation(used.R_WB).y() - model::rpy_from_rotation(truth.state.R_WB).y();
  result_.position_error = std::max(result_.position_error, (used.p_WB - truth.state.p_WB).norm());
  result_.pitch_error = std::max(result_.pitch_error, std::abs(pitch));
}

void LockstepRun::judge(const sim::PlantTruth& truth) {
  const core::ControlStatus& status = pipeline_.status();
  if (status.fault == Reason::none) fault_since_.reset();  // the operator cleared it
  if (const std::optional<std::string> fall = sim::fall_of(truth)) {
    if (status.phase == RobotPhase::damp) {
      end(RunOutcome::stopped, {Reason::stopped_by_user, "damped by the operator, then: " + *fall},
          truth);
      return;
    }
    const core::Refusal reason{fall_reason(pipeline_.last_active_phase()), *fall};
    scorer_.fell(reason);
    ++result_.falls;
    end(RunOutcome::fell, reason, truth);
  } else if (const std::optional<core::Refusal> fault = plant_.fault()) {
    end(RunOutcome::fault, *fault, truth);
  } else if (status.fault != Reason::none) {
    if (!fault_since_) fault_since_ = truth.state.stamp;
    if (truth.state.stamp.since(*fault_since_) > kWatchAfterFault) {
      end(RunOutcome::fault, pipeline_.end_reason(), truth);
    }
  } else if (const std::optional<MissionEnd> mission_end = pipeline_.end()) {
    const bool limited = request_.jumps_max > 0 &&
                         static_cast<int>(scorer_.jumps().size()) >= request_.jumps_max &&
                         request_.scenario.goal.jumps != request_.jumps_max;
    if (*mission_end == MissionEnd::refused) {
      end(RunOutcome::refused, pipeline_.end_reason(), truth);
    } else if (*mission_end == MissionEnd::stopped) {
      end(RunOutcome::stopped, pipeline_.end_reason(), truth);
    } else if (limited) {
      end(RunOutcome::stopped, {Reason::jump_count_reached, "as asked by --jumps"}, truth);
    } else {
      end(RunOutcome::completed, {}, truth);
    }
  } else if (now().seconds() > request_.config.runtime.time_limit) {
    end(RunOutcome::stopped, {Reason::time_limit, "runtime.time_limit_s is over"}, truth);
  }
}

void LockstepRun::stop() {
  if (!ended_) end(RunOutcome::stopped, {Reason::stopped_by_user, ""}, plant_.truth());
}

void LockstepRun::end(RunOutcome outcome, const core::Refusal& reason,
                      const sim::PlantTruth& truth) {
  scorer_.finish(truth);
  ended_ = true;
  result_.outcome = outcome;
  result_.reason = reason.text();
  result_.duration = now().seconds();
}

RunResult LockstepRun::result() const {
  RunResult result = result_;
  result.jumps = scorer_.jumps();
  result.timing.plan_ms = Percentiles::of(samples_.plan_ms);
  result.timing.replan_ms = Percentiles::of(samples_.replan_ms);
  result.timing.mpc_ms = Percentiles::of(samples_.mpc_ms);
  result.timing.perception_ms = Percentiles::of(samples_.perception_ms);
  result.timing.estimator_ms = Percentiles::of(samples_.estimator_ms);
  result.timing.tick_ms = Percentiles::of(samples_.tick_ms);
  return result;
}

}  // namespace hopscotch::apps
