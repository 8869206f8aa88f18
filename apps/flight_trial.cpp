#include "apps/flight_trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "apps/jump_scorer.hpp"
#include "apps/stage.hpp"
#include "control/control_tick.hpp"
#include "control/wrench_mpc.hpp"
#include "sim/judge.hpp"
#include "sim/mujoco_plant.hpp"
#include "sim/scene_builder.hpp"

namespace hopscotch::apps {

namespace {

constexpr double kStandTime = 0.6;  // before the jump [s]
constexpr double kRestTime = 0.6;   // of standing that ends the trial [s]
constexpr double kTimeMax = 8.0;    // [s]

sim::Scenario ground_of(const FlightTrial& trial) {
  const planner::StepRequest& step = trial.step;
  const double friction = trial.config.planner.friction;
  char slabs[256];
  if (step.height == 0.0) {
    std::snprintf(slabs, sizeof slabs, "  - {x_m: [-1.0, 3.0]}\n");
  } else {
    std::snprintf(slabs, sizeof slabs,
                  "  - {x_m: [-1.0, %.4f]}\n  - {x_m: [%.4f, %.4f], top_m: %.4f}\n", step.edge,
                  step.edge, step.edge + 3.0, step.height);
  }
  char head[160];
  std::snprintf(head, sizeof head, "name: one-jump\nrobot: %s\nfriction: %.4f\npit_depth_m: 1.5\n",
                trial.robot.name.c_str(), friction);
  return sim::Scenario::from_text(std::string(head) + "goal: {jumps: 1}\nslabs:\n" + slabs,
                                  "one jump");
}

double yaw_of(const std::array<Eigen::Isometry3d, core::kLegs>& X_WF) {
  const Eigen::Vector3d along = X_WF[0].linear().col(0) + X_WF[1].linear().col(0);
  return std::atan2(along.y(), along.x());
}

/// Number 0 is that of motions which nobody planned.
core::JumpPlan numbered(core::JumpPlan plan) {
  plan.id = std::max<std::uint64_t>(plan.id, 1);
  return plan;
}

/// Controller, MPC and plant, one millisecond after the other.
class TrialRun {
 public:
  TrialRun(const FlightTrial& trial, const sim::Scenario& scenario, const model::StandPose& pose)
      : trial_(trial),
        plant_({.scenario = scenario,
                .robot = trial.robot,
                .posture = {.q = pose.q, .trunk_pitch = pose.trunk_pitch},
                .variation = sim::StartVariation::none(),
                .seed = 1}),
        control_(trial.config.control, trial.robot, {pose.q, pose.trunk_pitch}),
        mpc_(trial.config.control.wrench_mpc, trial.robot),
        scorer_(trial.robot, scenario.true_terrain()),
        terrain_(scenario.true_terrain()),
        mpc_stage_({.name = "MPC", .latency = trial.config.runtime.mpc_latency, .thread = {}},
                   [this](const control::MpcQuestion& question, control::MpcAnswer& answer) {
                     answer = {.stamp = *asked_, .form = question.form};
                     answer.planned = question.reference.knots[0].wrenches;
                     answer.status = mpc_.solve(question.state, question.reference, question.form,
                                                answer.wrenches);
                   }) {
    mpc_stage_.question().reference.horizon =
        static_cast<std::size_t>(trial.config.control.wrench_mpc.horizon);
  }

  FlownJump run(const std::function<void(const core::RobotState&)>& observe) {
    bool goes_on = true;
    while (goes_on) {
      goes_on = step();
      if (observe) observe(truth_.state);
    }
    return result();
  }

 private:
  bool step() {
    (void)plant_.exchange(command_);
    truth_ = plant_.truth();
    const core::Stamp now = truth_.state.stamp;
    if (!offered_ && now.seconds() >= kStandTime) {
      offered_ = true;
      place_ = sim::takeoff_place(truth_);
      control_.offer(numbered(trial_.plan));
    }
    command_ = control_.tick(truth_.state);
    balance(now);
    scorer_.update(truth_, truth_.state, control_.status(), control_.plan());
    const bool standing = control_.phase() == core::RobotPhase::stand;
    if (!standing || scorer_.jumps().empty()) still_since_ = now;
    if (const std::optional<std::string> fall = sim::fall_of(truth_)) {
      scorer_.fell({core::Reason::fell_in_landing, *fall});
      return false;
    }
    if (control_.status().fault != core::Reason::none) {
      scorer_.fell({control_.status().fault, "the controller gave up"});
      return false;
    }
    return now.since(still_since_) < kRestTime && now.seconds() < kTimeMax;
  }

  void balance(core::Stamp now) {
    if (const control::MpcAnswer* const answer = mpc_stage_.take(now)) control_.answer(*answer);
    const bool due = !asked_ || now.since(*asked_) >= trial_.config.runtime.mpc_period - 1e-9;
    urgent_ = control_.wants_wrenches() && (urgent_ || control_.phase_changed());
    if (control_.wants_wrenches() && (due || urgent_) && mpc_stage_.vacant()) {
      asked_ = now;
      urgent_ = false;
      control_.question(mpc_stage_.question());
      mpc_stage_.ask(now);
    }
    (void)mpc_stage_.made();
  }

  FlownJump result() {
    scorer_.finish(truth_);
    FlownJump flown;
    if (!scorer_.jumps().empty()) flown.jump = scorer_.jumps().back();
    if (flown.jump.outcome == JumpOutcome::fell || !offered_) return flown;
    const sim::LandingVerdict verdict = sim::judge_landing(terrain_, trial_.robot, place_, truth_);
    flown.lateral = verdict.lateral;
    flown.yaw = yaw_of(truth_.X_WF) - place_.heading;
    flown.landing_error =
        std::hypot(verdict.distance - trial_.step.distance, verdict.lateral - trial_.step.lateral);
    return flown;
  }

  const FlightTrial& trial_;
  sim::MujocoPlant plant_;
  control::ControlTick control_;
  control::WrenchMpc mpc_;
  JumpScorer scorer_;
  sim::Terrain terrain_;
  core::JointCommand command_;
  sim::PlantTruth truth_;
  sim::TakeoffPlace place_{};
  core::Stamp still_since_;
  std::optional<core::Stamp> asked_;
  bool urgent_ = false;
  bool offered_ = false;
  Stage<control::MpcQuestion, control::MpcAnswer> mpc_stage_;
};

}  // namespace

FlownJump fly(const FlightTrial& trial,
              const std::function<void(const core::RobotState&)>& observe) {
  const std::optional<model::StandPose> pose =
      model::stand_pose(trial.robot, trial.config.stand_posture);
  if (!pose) throw core::ConfigError("stand_posture: " + trial.robot.name + " cannot stand so");
  return TrialRun(trial, ground_of(trial), *pose).run(observe);
}

std::string flight_scene(const FlightTrial& trial) {
  return sim::scene_mjcf(trial.robot, ground_of(trial).true_terrain());
}

}  // namespace hopscotch::apps
