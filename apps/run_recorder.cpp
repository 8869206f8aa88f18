#include "apps/run_recorder.hpp"

#include <sstream>

#include "apps/installation.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"
#include "sim/scene_builder.hpp"

namespace hopscotch::apps {

namespace fs = std::filesystem;

namespace {

/// Joint states and forces change slowly against a millisecond: every fourth tick keeps the log
/// small.
constexpr std::int64_t kTicksPerRecord = 4;

fs::path make_partial(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_regular_file(RunFolder{folder}.result())) {
    throw core::ConfigError(folder.string() + ": exists and is no run folder; give another --out");
  }
  const fs::path partial = folder.string() + ".partial";
  fs::remove_all(partial);
  fs::create_directories(partial);
  return partial;
}

std::string indented(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) result += "  " + line + "\n";
  return result;
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
      std::to_string(static_cast<int>(request.eyes)));
  return hash;
}

RunRecorder::RunRecorder(const fs::path& folder, std::uint64_t run_id, const RunRequest& request,
                         const RunSources& sources)
    : folder_(folder), partial_{make_partial(folder)}, log_(partial_.log(), run_id) {
  write_sources(request, sources);
  log_.write({}, scene_of(request.scenario, request.plant_robot.name));
}

RunRecorder::~RunRecorder() {
  if (finished_) return;
  std::error_code ignored;  // a run that failed leaves nothing behind
  fs::remove_all(partial_.path, ignored);
}

void RunRecorder::write_sources(const RunRequest& request, const RunSources& sources) const {
  write_file_atomically(partial_.config(),
                        "# Scenario and configuration of this run, as used.\n"
                        "scenario:\n" +
                            indented(sources.scenario) + "configuration:\n" +
                            indented(sources.configuration));
  write_file_atomically(partial_.robot(), sources.robot);
  write_file_atomically(partial_.scene(),
                        sim::scene_mjcf(request.plant_robot, request.scenario.true_terrain()));
}

void RunRecorder::record(const TickRecord& tick) {
  const core::Stamp now = tick.truth.state.stamp;
  const PipelineEvents& events = tick.events;
  log_.write(now, tick.readings);
  if (events.terrain) log_.write(now, *events.terrain);
  if (events.choice) log_.write(now, *events.choice);
  if (events.plan && events.plan->has_value()) log_.write(now, **events.plan);
  if (events.perception_ms) times_.perception_ms = *events.perception_ms;
  if (events.planning_ms) times_.plan_ms = *events.planning_ms;
  if (events.mpc_ms) times_.mpc_ms = *events.mpc_ms;
  times_.tick_ms = events.tick_ms;
  if (ticks_++ % kTicksPerRecord != 0) return;
  log_.write(now, tick.state);
  log_.write(now, tick.command);
  log_.write(now, msgs::Status{tick.status, tick.jump, 0, times_});
  log_.write(now, msgs::Truth{now, tick.truth.state, tick.truth.ground, tick.truth.tau});
  times_ = {};
}

RunFolder RunRecorder::finish(const RunResult& result) {
  log_.close();
  write_run_result(partial_.result(), result);
  fs::remove_all(folder_);
  fs::rename(partial_.path, folder_);
  finished_ = true;
  return {folder_};
}

}  // namespace hopscotch::apps
