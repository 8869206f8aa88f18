#include <unistd.h>

#include <fstream>

#include "apps/bench.hpp"
#include "apps/stopwatch.hpp"
#include "footstep/landing_selector.hpp"
#include "perception/one_step.hpp"
#include "perception/terrain_mapper.hpp"
#include "planner/step_target.hpp"
#include "sim/sim_camera.hpp"

namespace hopscotch::apps {

namespace {

constexpr const char* kLevelGround =
    "name: level-ground\n"
    "slabs:\n"
    "  - {x_m: [-1.0, 6.0]}\n"
    "goal: {jumps: 3}\n";

constexpr const char* kBoxes =
    "name: boxes\n"
    "slabs:\n"
    "  - {x_m: [-1.0, 0.175]}\n"
    "  - {x_m: [0.275, 0.625], top_m: 0.05}\n"
    "  - {x_m: [0.725, 1.075], top_m: 0.10}\n"
    "  - {x_m: [1.175, 1.525], top_m: 0.15}\n"
    "  - {x_m: [1.625, 3.5], top_m: 0.20}\n"
    "goal: {jumps: 1}\n";

/// Resident memory of this process now [MiB].
double resident_mebibytes() {
  std::ifstream statistics("/proc/self/statm");
  double total_pages = 0.0;
  double resident_pages = 0.0;
  statistics >> total_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

struct TrialSpeed {
  double per_minute = 0.0;
  double real_time_factor = 0.0;
  double step_us = 0.0;
};

TrialSpeed time_trials(const BenchSetup& setup, Eyes eyes) {
  const Stopwatch watch(TimeOf::thread);
  int jumps = 0;
  double simulated = 0.0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    RunRequest request = level_ground_run(setup, eyes);
    request.seed = seed;
    LockstepRun run(request);
    while (run.step({})) {
    }
    jumps += static_cast<int>(run.result().jumps.size());
    simulated += run.result().duration;
  }
  const double elapsed = 1e-3 * watch.milliseconds();
  return {60.0 * jumps / elapsed, simulated / elapsed, 1e3 * elapsed / simulated};
}

}  // namespace

RunRequest level_ground_run(const BenchSetup& setup, Eyes eyes) {
  RunRequest request;
  request.scenario = sim::Scenario::from_text(kLevelGround, "level ground");
  request.config = setup.config;
  request.robot = setup.robot;
  request.plant_robot = setup.robot;
  request.eyes = eyes;
  return request;
}

nlohmann::ordered_json bench_perception(const BenchSetup& setup) {
  const sim::Scenario scenario = sim::Scenario::from_text(kBoxes, "boxes");
  sim::SimCamera camera(scenario.camera, setup.robot, scenario.seen, 1);
  perception::TerrainMapper mapper(setup.config.perception, setup.robot);
  const footstep::LandingSelector selector(setup.config.footstep, setup.robot);
  const std::optional<model::StandPose> pose =
      model::stand_pose(setup.robot, setup.config.stand_posture);
  core::RobotState state = planner::standing_state(pose.value());
  (void)mapper.anchor_support(state);
  const double memory_before = resident_mebibytes();
  std::vector<double> render_ms;
  std::vector<double> frame_ms;
  constexpr int kFrames = 300;
  for (int frame = 0; frame < kFrames; ++frame) {
    state.stamp = core::Stamp::from_seconds((frame + 0.5) / scenario.camera.rate);
    camera.expose(state);
    const Stopwatch render(TimeOf::thread);
    const std::optional<core::DepthFrame> image = camera.poll(state.stamp.after(1.0));
    if (!image) continue;
    render_ms.push_back(render.milliseconds());
    const Stopwatch watch(TimeOf::thread);
    (void)mapper.integrate(*image, state);
    const perception::OneStepConfig& config = setup.config.perception.one_step;
    const core::OneStepTerrain terrain = perception::one_step_terrain(
        config, mapper.map(), perception::stance_pose(config, setup.robot, state));
    (void)selector.choose({mapper.map(), terrain}, state, {});
    frame_ms.push_back(watch.milliseconds());
  }
  return {{"n", frame_ms.size()},
          {"frame_ms", percentile_group(frame_ms, 1.0)},
          {"render_ms", percentile_group(render_ms, 1.0)},
          {"memory_MiB", resident_mebibytes() - memory_before}};
}

nlohmann::ordered_json bench_sim(const BenchSetup& setup) {
  const TrialSpeed truth = time_trials(setup, Eyes::truth);
  const TrialSpeed camera = time_trials(setup, Eyes::camera);
  return {{"n", 6},
          {"tick_of_everything_us", {{"truth", truth.step_us}, {"camera", camera.step_us}}},
          {"trials_per_minute", {{"truth", truth.per_minute}, {"camera", camera.per_minute}}},
          {"real_time_factor",
           {{"truth", truth.real_time_factor}, {"camera", camera.real_time_factor}}},
          {"memory_MiB", resident_mebibytes()}};
}

}  // namespace hopscotch::apps
