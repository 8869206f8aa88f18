#include <unistd.h>

#include <fstream>
#include <numeric>
#include <vector>

#include "apps/bench.hpp"
#include "apps/stopwatch.hpp"
#include "footstep/landing_selector.hpp"
#include "perception/occupancy.hpp"
#include "perception/one_step.hpp"
#include "perception/terrain_mapper.hpp"
#include "planner/step_target.hpp"
#include "sim/mujoco_plant.hpp"
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

/// Trials of one kind, and where their time went.
struct TrialTimes {
  std::vector<double> trial_ms;  ///< Thread CPU time of each.
  double simulated = 0.0;        ///< [s]
  double plan_ms = 0.0;
  double mpc_ms = 0.0;
  double perception_ms = 0.0;
  double tick_ms = 0.0;
  double plant_ms = 0.0;
  std::vector<double> step_us;  ///< Of each millisecond of the plant.
};

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// The plant alone, driven by the commands of a whole run: the same physics, step by step.
void time_plant(const RunRequest& request, const std::vector<core::JointCommand>& commands,
                TrialTimes& times) {
  const std::optional<model::StandPose> pose =
      model::stand_pose(request.robot, request.config.stand_posture);
  sim::MujocoPlant plant({.scenario = request.scenario,
                          .robot = request.plant_robot,
                          .posture = {.q = pose.value().q, .trunk_pitch = pose->trunk_pitch},
                          .variation = {},
                          .seed = request.seed});
  for (const core::JointCommand& command : commands) {
    const Stopwatch watch;
    (void)plant.exchange(command);
    times.step_us.push_back(1e3 * watch.milliseconds());
  }
}

/// Single jumps from standing to one second of rest, each with its own noise.
TrialTimes time_trials(const BenchSetup& setup, Eyes eyes, std::uint64_t trials) {
  TrialTimes times;
  for (std::uint64_t seed = 1; seed <= trials; ++seed) {
    const Stopwatch watch(TimeOf::thread);
    RunRequest request = level_ground_run(setup, eyes);
    request.seed = seed;
    request.jumps_max = 1;
    request.config.runtime.settle_time = 1.0;
    LockstepRun run(request);
    std::vector<core::JointCommand> commands;
    while (run.step([&](const TickRecord& tick) { commands.push_back(tick.command); })) {
    }
    times.trial_ms.push_back(watch.milliseconds());
    times.simulated += run.result().duration;
    times.plan_ms += sum(run.samples().plan_ms);
    times.mpc_ms += sum(run.samples().mpc_ms);
    times.perception_ms += sum(run.samples().perception_ms);
    times.tick_ms += sum(run.samples().tick_ms);
    const std::size_t before = times.step_us.size();
    time_plant(request, commands, times);
    for (std::size_t i = before; i < times.step_us.size(); ++i) {
      times.plant_ms += 1e-3 * times.step_us[i];
    }
  }
  return times;
}

double per_minute(const TrialTimes& times) {
  return 60e3 * static_cast<double>(times.trial_ms.size()) / sum(times.trial_ms);
}

/// Shares of the time; what is left is drawing depth frames, judging and bookkeeping.
nlohmann::ordered_json shares(const TrialTimes& times) {
  const double total = sum(times.trial_ms);
  const double known =
      times.plan_ms + times.mpc_ms + times.perception_ms + times.tick_ms + times.plant_ms;
  return {{"plan", times.plan_ms / total}, {"plant", times.plant_ms / total},
          {"mpc", times.mpc_ms / total},   {"perception", times.perception_ms / total},
          {"tick", times.tick_ms / total}, {"rest", 1.0 - known / total}};
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
  perception::OccupancyMemory volume(setup.config.perception.occupancy);
  std::vector<double> octomap_ms;
  std::vector<double> stage_ms;  ///< All that the perception stage does with a frame.
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
    stage_ms.push_back(watch.milliseconds());
    const perception::OneStepConfig& config = setup.config.perception.one_step;
    const core::OneStepTerrain terrain = perception::one_step_terrain(
        config, mapper.map(), perception::stance_pose(config, setup.robot, state));
    (void)selector.choose({mapper.map(), terrain}, state, {});
    frame_ms.push_back(watch.milliseconds());
    const Stopwatch voxels(TimeOf::thread);
    if (!volume.insert(*mapper.image(), image->stamp)) continue;
    (void)volume.hanging();
    octomap_ms.push_back(voxels.milliseconds());
    stage_ms.back() += octomap_ms.back();
  }
  return {{"n", frame_ms.size()},
          {"frame_ms", percentile_group(frame_ms, 1.0)},
          {"octomap_ms", percentile_group(octomap_ms, 1.0)},
          {"stage_ms", percentile_group(stage_ms, 1.0)},
          {"render_ms", percentile_group(render_ms, 1.0)},
          {"memory_MiB", resident_mebibytes() - memory_before}};
}

nlohmann::ordered_json bench_sim(const BenchSetup& setup) {
  constexpr std::uint64_t kTruthTrials = 20;
  constexpr std::uint64_t kCameraTrials = 8;
  const double memory_before = resident_mebibytes();
  const TrialTimes truth = time_trials(setup, Eyes::truth, kTruthTrials);
  const TrialTimes camera = time_trials(setup, Eyes::camera, kCameraTrials);
  return {{"n", truth.trial_ms.size() + camera.trial_ms.size()},
          {"step_us", percentile_group(truth.step_us, 1.0)},
          {"trials_per_minute", {{"truth", per_minute(truth)}, {"camera", per_minute(camera)}}},
          {"real_time_factor", 1e3 * truth.simulated / sum(truth.trial_ms)},
          {"real_time_factor_camera", 1e3 * camera.simulated / sum(camera.trial_ms)},
          {"shares", {{"truth", shares(truth)}, {"camera", shares(camera)}}},
          {"memory_MiB", resident_mebibytes() - memory_before}};
}

}  // namespace hopscotch::apps
