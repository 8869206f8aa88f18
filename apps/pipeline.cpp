#include "apps/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/shipped_jumps.hpp"
#include "apps/stopwatch.hpp"
#include "core/allocation_count.hpp"
#include "core/check.hpp"
#include "model/kinematics.hpp"
#include "model/stand_posture.hpp"
#include "perception/one_step.hpp"

namespace hopscotch::apps {

using core::RobotPhase;

namespace {

/// Of the ground at the place a plan led to, as the map had it [m].
double height_aimed_at(const core::JumpPlan& plan) {
  return plan.target.p_WS.z() + plan.target.height;
}

planner::Formulation formulation_of(core::Ablation ablation) {
  return ablation == core::Ablation::srbd_only ? planner::Formulation::single_body
                                               : planner::Formulation::variable;
}

/// As HOP_SENSORS carries them, so that a replay of the log computes from the same bits.
core::SensorReadings recorded(core::SensorReadings readings) {
  const auto round = [](auto& numbers) {
    for (double& number : numbers) {
      // GCC 12 forgets to round the last two of ten without it.
      volatile const auto kept = static_cast<float>(number);
      number = static_cast<double>(kept);
    }
  };
  round(readings.q);
  round(readings.dq);
  round(readings.tau);
  round(readings.w_WB_B);
  round(readings.f_B);
  return readings;
}

}  // namespace

Pipeline::Pipeline(const ProgramConfig& config, const model::RobotParameters& robot,
                   const Mission& mission, TerrainOracle oracle, Threading threading)
    : config_(config),
      robot_(robot),
      mission_(mission),
      oracle_(std::move(oracle)),
      estimator_(config.control.estimator, robot, mission.start),
      mapper_(config.perception, robot),
      volume_(config.perception.occupancy),
      doubt_(config.footstep.doubt),
      selector_(config.footstep, robot),
      planner_(config.planner, robot, shipped_jumps(robot.name, config.planner.steps)),
      replanner_(config.planner, robot),
      mpc_(config.control.wrench_mpc, robot),
      sight_({.name = "perception",
              .latency = config.runtime.perception_latency,
              .threaded = threading == Threading::threads,
              .thread = config.threads.perception},
             [this](const SightQuestion& seen, Sight& sight) {
               sight.exposed = seen.frame.stamp;
               sight.status = mapper_.integrate(seen.frame, seen.at_exposure);
               sight.map = std::make_shared<const core::TerrainMap>(mapper_.map());
               const bool fused = sight.status == perception::MapStatus::fused;
               sight.hanging.reset();
               if (fused && volume_.insert(*mapper_.image(), seen.frame.stamp)) {
                 sight.hanging =
                     std::make_shared<const std::vector<Eigen::Vector3f>>(volume_.hanging());
               }
             }),
      decision_({.name = "planning",
                 .latency = config.runtime.planning_latency,
                 .threaded = threading == Threading::threads,
                 .thread = config.threads.planning},
                [this](const DecisionQuestion& question, Decision& decision) {
                  make_decision(question, decision);
                }),
      rest_({.name = "re-planning",
             .latency = config.runtime.replanning_latency,
             .threaded = threading == Threading::threads,
             .thread = config.threads.planning},
            [this](const planner::RestRequest& request, Rest& rest) {
              rest = replanner_.replan(request);
            }),
      balance_({.name = "MPC",
                .latency = config.runtime.mpc_latency,
                .threaded = threading == Threading::threads,
                .thread = config.threads.mpc},
               [this](const BalanceQuestion& question, control::MpcAnswer& answer) {
                 const auto& [state, reference, form] = question.mpc;
                 answer = {.stamp = question.now, .form = form};
                 answer.planned = reference.knots[0].wrenches;
                 answer.status = mpc_.solve(state, reference, form, answer.wrenches);
               }) {
  task_.goal_x = mission.goal_x;
  task_.source = oracle_ ? core::TargetSource::truth : core::TargetSource::perception;
  balance_.question().mpc.reference.horizon =
      static_cast<std::size_t>(config.control.wrench_mpc.horizon);
}

core::JointCommand Pipeline::tick(const core::SensorReadings& measured, core::DepthSource& camera) {
  events_ = {};
  const core::SensorReadings readings = recorded(measured);
  if (control_ && readings.stamp <= state_.stamp) return command_;
  if (!control_) events_.put_down = mission_.start;
  events_.expected = control_ ? control_->expected_contact() : control::ContactExpectation::support;
  const Stopwatch watch;
  const std::size_t before = core::allocation_count();
  state_ = estimator_.update(readings, *events_.expected);
  events_.allocations += core::allocation_count() - before;
  events_.estimator_ms = watch.milliseconds();
  if (control_) control_->observe_drives(readings);
  run_stages(camera);
  if (calmed_down_) {
    events_.map_height = height_aimed_at(control_->plan());
    estimator_.correct_height(*events_.map_height);
  }
  return command_;
}

core::JointCommand Pipeline::tick(const core::RobotState& state, core::DepthSource& camera) {
  events_ = {};
  state_ = state;
  run_stages(camera);
  return command_;
}

// DepthFrame -> TerrainMap -> TargetChoice -> JumpPlan -> ContactWrenches -> JointCommand
void Pipeline::run_stages(core::DepthSource& camera) {
  if (!control_) start(state_);
  history_.add(state_);
  compare_height(state_);
  look(state_.stamp, camera);
  decide(state_);
  const Stopwatch watch;
  const std::size_t before = core::allocation_count();
  command_ = control_->tick(state_);
  events_.allocations += core::allocation_count() - before;
  events_.tick_ms = watch.milliseconds();
  replan(state_.stamp);
  balance(state_.stamp);
  watch_mission(state_);
  if (end_) desk_.withdraw_target("the run ended first");
  events_.answers = desk_.take_answers();
}

/// Once a landing has calmed down, its height says how far the map is to be believed.
void Pipeline::compare_height(const core::RobotState& state) {
  const bool jumped = jumps_done_ > 0;  // after a fall the soles say how high the map is
  calmed_down_ =
      jumped && !height_checked_ && state.stamp.since(landed_) >= config_.runtime.look_time;
  if (!calmed_down_) return;
  height_checked_ = true;
  const auto soles = model::sole_poses(robot_, control_->rest_state());
  doubt_.landed(0.5 * (soles[0].translation().z() + soles[1].translation().z()) -
                height_aimed_at(control_->plan()));
}

void Pipeline::start(const core::RobotState& state) {
  const std::optional<model::StandPose> pose = model::stand_pose(robot_, config_.stand_posture);
  HOPSCOTCH_CHECK(pose.has_value());  // start-up refuses a posture that cannot be taken
  control_.emplace(config_.control, robot_, control::StandTarget{pose->q, pose->trunk_pitch});
  mapper_.anchor_support(state);
  events_.anchor = state;
  map_ = std::make_shared<const core::TerrainMap>(mapper_.map());
  landed_ = state.stamp;
  last_seen_ = state.stamp;
  still_since_ = state.stamp;
  last_mpc_ = state.stamp.after(-config_.runtime.mpc_period);
}

/// A depth frame that has arrived goes into the map; the map counts once perception's latency has
/// passed.
void Pipeline::look(core::Stamp now, core::DepthSource& camera) {
  if (Sight* const sight = sight_.take(now)) {
    map_ = std::move(sight->map);
    if (sight->hanging) hanging_ = std::move(sight->hanging);
    const bool fused = sight->status == perception::MapStatus::fused;
    if (fused && sight->exposed > landed_) ++frames_since_landing_;
    if (fused) last_seen_ = std::max(last_seen_, sight->exposed);
  }
  // A robot that was dropped had its soles in the air when the map was tied to them.
  const bool fallen = !height_checked_ && jumps_done_ == 0;
  if (fallen && sight_.vacant() && now.since(landed_) >= config_.runtime.look_time) {
    height_checked_ = true;
    frames_since_landing_ = 0;
    mapper_ = perception::TerrainMapper(config_.perception, robot_);
    volume_ = perception::OccupancyMemory(config_.perception.occupancy);
    mapper_.anchor_support(state_);
    events_.anchor = state_;
    map_ = std::make_shared<const core::TerrainMap>(mapper_.map());
  }
  while (sight_.vacant()) {
    std::optional<core::DepthFrame> frame = camera.poll(now);
    if (!frame) break;
    const std::optional<core::RobotState> at_exposure = history_.at(frame->stamp);
    if (!at_exposure) continue;  // older than the history: it cannot be placed
    events_.seen = &sight_.question();
    sight_.question() = {std::move(*frame), *at_exposure};
    sight_.ask(now);
  }
  if (sight_.made() != nullptr) events_.perception_ms = sight_.work_ms();
}

/// Where to, and how: the next jump is chosen and planned while the present one lands.
void Pipeline::decide(const core::RobotState& state) {
  refuse_if_locked();
  if (const Decision* const decision = decision_.take(state.stamp)) receive_plan(*decision);
  if (is_idle(state) && is_blind(state.stamp)) {
    for_operator_ = desk_.due().has_value();
    // Made once: it is said at every tick.
    static const core::Refusal blind{core::Reason::terrain_unseen,
                                     "no usable depth frame comes any more"};
    refuse(state.stamp, blind);
  } else if (may_decide(state)) {
    ask_where(state);
  }
  if (const Decision* const decision = decision_.made()) weigh(state.stamp, *decision);
}

/// While a jump pushes off or lands, what is left of it is planned anew from where the robot is,
/// again and again. The plan in hand counts until another one is certified.
void Pipeline::replan(core::Stamp now) {
  if (const Rest* const rest = rest_.take(now); rest != nullptr && **rest) {
    events_.replanned = control_->replace_rest(***rest, rest_place_);
    mpc_urgent_ = mpc_urgent_ || events_.replanned;
  }
  if (rest_.made() != nullptr) events_.replanning_ms = rest_.work_ms();
  const bool lands = control_->phase() == RobotPhase::landing;
  const RuntimeConfig& runtime = config_.runtime;
  if (!(lands ? runtime.landing_replanning : runtime.takeoff_replanning)) return;
  const core::JumpPlan& plan = control_->plan();
  const SolvedJump& jump = plan.id == planned_.plan_id ? planned_ : under_way_;
  if (!rest_.vacant() || plan.id != jump.plan_id || !jump.solution) return;
  const auto question = control_->rest_question(runtime.replanning_latency);
  if (!question) return;
  const planner::StepCounts& steps = config_.planner.steps;
  const double since_touchdown = question->place.begin - plan.touchdown_time;
  const int steps_done =
      lands ? steps.takeoff + steps.flight +
                  planner::landing_steps_begun(config_.planner, *jump.solution, since_touchdown)
            : static_cast<int>(question->place.knot);
  if (!planner::rest_steps(steps, steps_done)) return;
  rest_place_ = question->place;
  rest_.question() = {.id = plan.id,
                      .whole = jump.solution,
                      .steps_done = steps_done,
                      .state = question->state,
                      .target = plan.target,
                      .final_posture = config_.stand_posture};
  rest_.ask(now);
}

/// The MPC answers once its latency has passed; a touchdown or a take-off asks at once.
void Pipeline::balance(core::Stamp now) {
  if (const control::MpcAnswer* const answer = balance_.take(now)) control_->answer(*answer);
  mpc_urgent_ = control_->wants_wrenches() && (mpc_urgent_ || control_->phase_changed());
  const bool due = now.since(last_mpc_) >= config_.runtime.mpc_period - 1e-9;
  if (control_->wants_wrenches() && (due || mpc_urgent_) && balance_.vacant()) {
    last_mpc_ = now;
    mpc_urgent_ = false;
    balance_.question().now = now;
    control_->question(balance_.question().mpc);
    balance_.ask(now);
  }
  if (balance_.made() != nullptr) events_.mpc_ms = balance_.work_ms();
}

/// The next jump is wanted and nothing is known of it, or the operator wants another one than that
/// which waits.
bool Pipeline::is_idle(const core::RobotState& state) const {
  if (end_ || !decision_.vacant()) return false;
  if (control_->has_next() && !desk_.due()) return false;
  if (held() && !desk_.due()) return false;
  const RobotPhase phase = control_->phase();
  if (!core::is_standing(phase) && phase != RobotPhase::landing) return false;
  return state.stamp.since(landed_) >= config_.runtime.look_time && !mission_accomplished(state);
}

bool Pipeline::may_decide(const core::RobotState& state) const {
  const bool looked = oracle_ || frames_since_landing_ >= config_.runtime.look_frames;
  return looked && is_idle(state);
}

/// What the map says may no longer be so.
bool Pipeline::is_blind(core::Stamp now) const {
  return !oracle_ && now.since(last_seen_) > config_.runtime.sight_age_max;
}

void Pipeline::ask_where(const core::RobotState& state) {
  for_operator_ = desk_.due().has_value();
  footstep::LandingTask task = task_;
  if (for_operator_) task.target = desk_.due();
  task.height_doubt = doubt_.height();
  is_next_best_ = task.target.has_value() && !for_operator_;
  const auto jump = static_cast<std::size_t>(jumps_done_);
  if (!task.target && jump < mission_.targets.size()) task.target = mission_.targets[jump];
  events_.asked = &decision_.question();
  decision_.question() = {map_,
                          hanging_,
                          control_->rest_state(),
                          task,
                          for_operator_,
                          ++plans_made_,
                          oracle_ ? oracle_(state) : MapDrawing{}};
  decision_.ask(state.stamp);
}

/// On the planning stage's thread.
void Pipeline::make_decision(const DecisionQuestion& question, Decision& decision) {
  const auto& [seen, hanging, rest, task, for_operator, plan_id, draw_map] = question;
  const auto map = draw_map ? std::make_shared<const core::TerrainMap>(draw_map()) : seen;
  const perception::OneStepConfig& one_step = config_.perception.one_step;
  decision.map = map;
  decision.terrain =
      perception::one_step_terrain(one_step, *map, perception::stance_pose(one_step, robot_, rest));
  decision.choice = selector_.choose({*map, decision.terrain, *hanging}, rest, task);
  decision.plan.reset();
  if (!decision.choice.target) return;
  if (!for_operator) decision.choice.target->source = task.source;  // the next best is no wish
  planner::PlanRequest request{.start = rest,
                               .target = *decision.choice.target,
                               .final_posture = config_.stand_posture,
                               .id = plan_id,
                               .formulation = formulation_of(config_.control.ablation)};
  plan_jump(request, decision);
  // Ground that cannot be cleared as high as it might be is cleared as high as possible.
  footstep::LandingTask bolder = task;
  for (const double share : {0.5, 0.0}) {
    if (*decision.plan || task.height_doubt == 0.0) return;
    bolder.height_doubt = share * task.height_doubt;
    const core::TargetChoice again =
        selector_.choose({*map, decision.terrain, *hanging}, rest, bolder);
    if (again.target) request.target.profile = again.target->profile;
    plan_jump(request, decision);
  }
}

/// On the planning stage's thread.
void Pipeline::plan_jump(const planner::PlanRequest& request, Decision& decision) {
  decision.plan = planner_.plan(request);
  const bool wanted = config_.runtime.takeoff_replanning || config_.runtime.landing_replanning;
  decision.solution = wanted ? planner_.solution() : nullptr;
}

void Pipeline::weigh(core::Stamp now, const Decision& decision) {
  events_.map = decision.map;
  events_.terrain = decision.terrain;
  events_.choice = decision.choice;
  if (!decision.choice.target) {
    decision_.drop();
    refuse(now, decision.choice.refusal);
    return;
  }
  refused_since_.reset();
  if (!is_next_best_ && !for_operator_) choice_ = decision.choice;
  choice_.target = decision.choice.target;
  events_.plan = decision.plan;
  events_.planning_ms = decision_.work_ms();
}

void Pipeline::receive_plan(const Decision& decision) {
  const core::Result<core::JumpPlan>& plan = *decision.plan;
  task_.target.reset();
  if (for_operator_) {
    const core::ControlStatus& status = control_->status();
    const bool landing = status.phase == RobotPhase::landing;
    const double start_in =
        landing ? std::max(0.0, control_->plan().duration - status.plan_time) : 0.0;
    const bool check_only = desk_.check_only();
    if (plan) desk_.accept_target(start_in);
    if (!plan) desk_.refuse_target(plan.error());
    if (!plan || check_only) return;
  }
  if (plan) {
    failed_distances_.clear();
    control_->offer(*plan);
    if (planned_.plan_id == control_->plan().id) under_way_ = planned_;
    planned_ = {plan->id, decision.solution};
  } else {
    next_best(plan.error());
  }
}

/// A target that cannot be planned makes way for the next best one that is not about the same.
void Pipeline::next_best(const core::Refusal& refusal) {
  constexpr double kSamePlace = 0.04;  // [m]
  failed_distances_.push_back(choice_.target->distance);
  for (std::size_t i = 0; i < choice_.ranked_count; ++i) {
    const double distance = choice_.ranked[i].distance;
    const bool tried = std::any_of(failed_distances_.begin(), failed_distances_.end(),
                                   [&](double d) { return std::abs(d - distance) < kSamePlace; });
    if (!tried) {
      task_.target = core::TargetOverride{.distance = distance};
      return;
    }
  }
  end_ = MissionEnd::refused;
  end_reason_ = refusal;
}

/// No target now may be one a few frames later.
void Pipeline::refuse(core::Stamp now, const core::Refusal& refusal) {
  task_.target.reset();
  if (for_operator_) {
    desk_.refuse_target(refusal);
    return;
  }
  if (!refused_since_) refused_since_ = now;
  if (now.since(*refused_since_) < config_.runtime.patience) return;
  end_ = MissionEnd::refused;
  end_reason_ = refusal;
}

/// Both heels beyond the goal, or all jumps made.
bool Pipeline::mission_accomplished(const core::RobotState& state) const {
  if (mission_.jumps > 0 && jumps_done_ >= mission_.jumps) return true;
  if (std::isnan(mission_.goal_x)) return false;
  const auto soles = model::sole_poses(robot_, state);
  return std::all_of(soles.begin(), soles.end(), [&](const Eigen::Isometry3d& X_WF) {
    return model::sole_tips(robot_, X_WF).heel.x() > mission_.goal_x;
  });
}

/// A jump that goes wrong before it rises is tried again: a push, a slip. One that always does will
/// always do.
/// @param plan_id Of the landing that begins; 0 if it is not that of a jump: one called off lands
/// without having flown.
void Pipeline::count_called_off(std::uint64_t plan_id) {
  constexpr int kMost = 4;
  called_off_ = plan_id == 0 && last_phase_ != RobotPhase::flight ? called_off_ + 1 : 0;
  if (called_off_ < kMost || end_) return;
  end_ = MissionEnd::refused;
  end_reason_ = {
      core::Reason::plan_infeasible,
      std::to_string(kMost) + " jumps in a row strayed from their plans before they rose"};
}

/// Counts landings and notices when nothing is left to do.
void Pipeline::watch_mission(const core::RobotState& state) {
  const core::ControlStatus& status = control_->status();
  if (control_->phase_changed() && status.phase == RobotPhase::landing) {
    landed_ = state.stamp;
    last_seen_ = state.stamp;
    frames_since_landing_ = 0;
    const bool jumped = status.plan_id != 0;  // and did not fall
    height_checked_ = !jumped && jumps_done_ > 0;
    jumps_done_ += jumped ? 1 : 0;
    count_called_off(status.plan_id);
  }
  const bool standing = status.phase == RobotPhase::stand || status.phase == RobotPhase::hold;
  const bool still = standing && state.v_WB.norm() < config_.runtime.settle_speed;
  if (!still) still_since_ = state.stamp;
  if (!core::is_limp(status.phase)) last_phase_ = status.phase;
  if (end_) return;
  if (status.fault != core::Reason::none) {
    end_ = MissionEnd::fault;
    end_reason_ = {status.fault,
                   "the controller gave up in " + std::string(core::robot_phase_name(last_phase_))};
  } else if (state.stamp.since(still_since_) >= config_.runtime.settle_time) {
    if (mission_accomplished(state)) {
      end_ = MissionEnd::reached;
    } else if (desk_.mode() == OperatorDesk::Mode::stopping) {
      end_ = MissionEnd::stopped;
      end_reason_ = {core::Reason::stopped_by_user, "by the operator's command"};
    }
  }
}

}  // namespace hopscotch::apps
