#include "apps/run_recorder.hpp"

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "apps/installation.hpp"
#include "apps/live_run.hpp"
#include "apps/map_view.hpp"
#include "apps/run_config.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"
#include "sim/scene_builder.hpp"

namespace hopscotch::apps {

namespace fs = std::filesystem;

namespace {

/// Motion is smooth but for the moments around a change of phase or contact. Beside depth frames
/// it counts for little, and calibration wants it whole.
constexpr int kTicksPerRecord = 20;
constexpr int kTicksPerLivelyRecord = 4;
constexpr int kLivelyTicks = 20;

/// The larger one; a NaN counts as none.
void keep_largest(const std::optional<double>& value, double& largest) {
  if (value) largest = std::fmax(*value, largest);
}

fs::path make_partial(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_regular_file(RunFolder{folder}.result())) {
    throw core::ConfigError(folder.string() + ": exists and is no run folder; give another --out");
  }
  fs::path partial = folder.string() + ".partial";
  fs::remove_all(partial);
  fs::create_directories(partial);
  return partial;
}

msgs::Scene scene_of(const sim::Scenario& scenario, const std::string& robot) {
  msgs::Scene scene;
  scene.robot = robot;
  if (scenario.goal.x) scene.goal_x = *scenario.goal.x;
  const sim::Terrain terrain = scenario.true_terrain();
  scene.pit_z = -terrain.pit_depth;
  for (std::size_t i = 0; i < terrain.slabs.size() && i < msgs::Scene::kMaxSlabs; ++i) {
    scene.slabs[i].top = terrain.slabs[i].top_corners();
    scene.slabs[i].seen_rise = scenario.seen.slabs[i].top - terrain.slabs[i].top;
    scene.slab_count = i + 1;
  }
  return scene;
}

}  // namespace

std::uint64_t run_identity(const RunSources& sources, const RunRequest& request) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a
  const auto mix = [&hash](std::string_view text) {
    for (const char c : text) {
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    }
  };
  mix(sources.scenario);
  mix(sources.configuration);
  mix(sources.robot);
  mix(program_version());
  mix(std::to_string(request.seed) + " " + std::to_string(request.jumps_max) + " " +
      std::to_string(static_cast<int>(request.eyes)) + " " +
      std::to_string(static_cast<int>(request.state)) + " " +
      std::string(core::ablation_name(request.ablation)));
  return hash;
}

RunRecorder::RunRecorder(const fs::path& folder, std::uint64_t run_id, const RunRequest& request,
                         const RunSources& sources)
    : folder_(folder),
      log_depth_(request.log_depth),
      partial_{make_partial(folder)},
      maker_(run_id),
      log_(partial_.log(), run_id),
      scene_(maker_.make({}, scene_of(request.scenario, request.plant_robot.name))) {
  write_sources(request, sources);
  write(scene_);
}

RunRecorder::~RunRecorder() {
  if (finished_) return;
  std::error_code ignored;  // a run that failed leaves nothing behind
  fs::remove_all(partial_.path, ignored);
}

void RunRecorder::write_sources(const RunRequest& request, const RunSources& sources) const {
  write_file_atomically(partial_.config(),
                        run_config_text(sources.scenario, sources.configuration));
  write_file_atomically(partial_.robot(), sources.robot);
  write_file_atomically(partial_.scene(),
                        sim::scene_mjcf(request.plant_robot, request.scenario.true_terrain()));
}

void RunRecorder::add_listener(Listener listener) {
  listener(scene_);
  listeners_.push_back(std::move(listener));
}

void RunRecorder::put(const msgs::Event& event) {
  for (const Listener& listener : listeners_) listener(event);
  keep(event);
}

/// What only a replay wants to know.
void RunRecorder::keep(const msgs::Event& event) {
  black_box_.remember(event);
  write(event);
}

/// Into the log alone: depth is too much for listeners and for the black box.
void RunRecorder::write(const msgs::Event& event) {
  if (log_broken_) return;
  try {
    log_.write(event);
  } catch (const std::runtime_error& error) {
    log_broken_ = true;
    std::fprintf(stderr, "hopscotch: %s: the run goes on, its log ends at %.2f s\n", error.what(),
                 event.now.seconds());
  }
}

void RunRecorder::record(core::Stamp now, const core::OperatorCommand& command) {
  const core::Stamp made{static_cast<std::int64_t>(command.sequence) * 1000};
  const msgs::Tag tag{command.sequence, command.run_id};
  if (command.mode == core::ModeRequest::none) {
    const msgs::TargetCommand message{made, command.target};
    put({now, msgs::channel_of(message), msgs::encode(message, tag)});
  } else {
    const msgs::ModeCommand message{made, command.mode, command.goal_x};
    put({now, msgs::channel_of(message), msgs::encode(message, tag)});
  }
}

void RunRecorder::record(core::Stamp now, const core::OperatorAnswer& answer) {
  put(now, ack_of(now, answer));
}

/// A robot that finds no target decides anew every tick: the same refusal is not written a thousand
/// times a second.
void RunRecorder::record_decision(core::Stamp now, const PipelineEvents& events) {
  constexpr double kMapPeriod = 0.25;      // [s]
  constexpr double kRefusalPeriod = 0.05;  // [s]
  if (events.map != nullptr && events.terrain && now >= next_map_) {
    constexpr double kAhead = 0.45;  // middle of what a jump can reach [m]
    const double heading = events.terrain->heading;
    put(now, map_view(*events.map, events.terrain->p_WS.x() + kAhead * std::cos(heading),
                      events.terrain->p_WS.y() + kAhead * std::sin(heading)));
    next_map_ = now.after(kMapPeriod);
  }
  const core::Reason refused = events.choice ? events.choice->refusal.reason : core::Reason::none;
  const bool repeated = refused != core::Reason::none && refused == refused_ && now < next_refusal_;
  if (!repeated) {
    if (events.terrain) put(now, *events.terrain);
    if (events.choice) put(now, *events.choice);
    if (events.choice) next_refusal_ = now.after(kRefusalPeriod);
  }
  if (events.choice) refused_ = refused;
  if (events.plan && events.plan->has_value()) put(now, **events.plan);
}

void RunRecorder::record(const TickRecord& tick) {
  const core::Stamp now = tick.truth.state.stamp;
  const PipelineEvents& events = tick.events;
  record_prior(now, events);
  put(now, tick.readings);
  if (log_depth_) record_perception(now, events);
  record_question(now, events);
  record_decision(now, events);
  for (const core::OperatorAnswer& answer : events.answers) record(now, answer);
  keep_largest(events.perception_ms, times_.perception_ms);
  keep_largest(events.planning_ms, times_.plan_ms);
  keep_largest(events.mpc_ms, times_.mpc_ms);
  keep_largest(events.estimator_ms, times_.estimator_ms);
  keep_largest(events.tick_ms, times_.tick_ms);
  if (!motion_due(tick)) return;
  put(now, tick.state);
  put(now, tick.command);
  put(now, msgs::Status{tick.status, tick.jump, 0, tick.held, times_});
  put(now, msgs::Truth{now, tick.truth.state, tick.truth.ground, tick.truth.tau});
  times_ = {};
}

bool RunRecorder::motion_due(const TickRecord& tick) {
  const auto& contact = tick.truth.state.contact;
  const bool changed = tick.status.phase != phase_ || contact != contact_;
  phase_ = tick.status.phase;
  contact_ = contact;
  since_change_ = changed ? 0 : since_change_ + 1;
  const bool lively = log_depth_ || since_change_ < kLivelyTicks;
  const int spacing = lively ? kTicksPerLivelyRecord : kTicksPerRecord;
  if (++since_record_ < spacing) return false;
  since_record_ = 0;
  return true;
}

/// Before the readings that it holds for.
void RunRecorder::record_prior(core::Stamp now, const PipelineEvents& events) {
  if (!events.expected) return;
  if (events.put_down || told_height_ || *events.expected != expected_) {
    msgs::EstimatorPrior prior{.stamp = now,
                               .start = std::nullopt,
                               .expected = static_cast<std::uint8_t>(*events.expected),
                               .height = told_height_.value_or(core::kNaN)};
    if (events.put_down) prior.start = {events.put_down->p_WS, events.put_down->yaw};
    keep(maker_.make(now, prior));
  }
  expected_ = *events.expected;
  told_height_ = events.map_height;
}

void RunRecorder::close_log() {
  try {
    log_.close();
  } catch (const std::runtime_error& error) {
    if (!log_broken_) std::fprintf(stderr, "hopscotch: %s: the log is cut short\n", error.what());
    log_broken_ = true;
  }
}

/// A run folder of its own, so that `explain`, `report` and `view` take it.
void RunRecorder::write_black_box(const RunResult& result) const {
  const bool wrong = result.outcome == RunOutcome::fell || result.outcome == RunOutcome::fault;
  if (!wrong) return;
  const RunFolder box{partial_.black_box()};
  try {
    fs::create_directories(box.path);
    black_box_.write(box.log(), scene_);
    for (const auto file : {&RunFolder::config, &RunFolder::robot, &RunFolder::scene}) {
      fs::copy_file((partial_.*file)(), (box.*file)());
    }
    write_run_result(box.result(), result);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hopscotch: no black box: %s\n", error.what());
  }
}

/// In the order in which the stages took them in: a replay does the same.
void RunRecorder::record_perception(core::Stamp now, const PipelineEvents& events) {
  if (events.anchor) keep(maker_.make(now, msgs::AnchorRecord{*events.anchor}));
  if (events.seen != nullptr) {
    write(maker_.make(now, msgs::DepthRecord{events.seen->frame, events.seen->at_exposure}));
  }
}

void RunRecorder::record_question(core::Stamp now, const PipelineEvents& events) {
  if (events.asked == nullptr) return;
  const footstep::LandingTask& task = events.asked->task;
  keep(maker_.make(now, msgs::TargetQuestion{.stamp = now,
                                             .map_stamp = events.asked->map->stamp,
                                             .rest = events.asked->rest,
                                             .goal_x = task.goal_x,
                                             .goal_heading = task.goal_heading,
                                             .source = task.source,
                                             .target = task.target,
                                             .height_doubt = task.height_doubt,
                                             .for_operator = events.asked->for_operator}));
}

RunFolder RunRecorder::finish(const RunResult& result) {
  close_log();
  write_run_result(partial_.result(), result);
  write_black_box(result);
  fs::remove_all(folder_);
  fs::rename(partial_.path, folder_);
  finished_ = true;
  return {folder_};
}

}  // namespace hopscotch::apps
