#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/lockstep_run.hpp"
#include "apps/program_config.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::apps {

/// What every benchmark works with.
struct BenchSetup {
  ProgramConfig config;
  model::RobotParameters robot;
};

/// {p50, p99, max} of samples, scaled, for one key of a benchmark's JSON.
[[nodiscard]] nlohmann::ordered_json percentile_group(std::vector<double> samples, double scale);

/// Three leaps on level ground, seed 1.
[[nodiscard]] RunRequest level_ground_run(const BenchSetup& setup, Eyes eyes);

/// Cold and warm solves over a grid of reachable targets; times are thread CPU time.
/// @param count  Of the targets, spread evenly.
[[nodiscard]] nlohmann::ordered_json bench_planner(const BenchSetup& setup, int count);

/// Which jumps are flown: so many of the targets from standing, spread evenly, or with a seed
/// drawn at random from between them.
struct FlightSample {
  int flights = 0;
  std::uint64_t seed = 0;  ///< 0: evenly.
};
/// Plans to a sample of the targets, and how MuJoCo flies them on the true state.
[[nodiscard]] nlohmann::ordered_json bench_flights(const BenchSetup& setup,
                                                   const FlightSample& sample);
/// The planner's formulation beside those it is compared with: solve time, and what MuJoCo makes of
/// what each promises, for three jumps.
[[nodiscard]] nlohmann::ordered_json bench_formulations(const BenchSetup& setup);
/// The QPs of a simulated run; with a file of recorded QPs those, against their reference.
/// @throws core::ConfigError if `qps` is given and is no such file.
[[nodiscard]] nlohmann::ordered_json bench_mpc(const BenchSetup& setup,
                                               const std::filesystem::path& qps);
/// Frames of the default camera while the robot crosses boxes: drawing, and frame to target.
[[nodiscard]] nlohmann::ordered_json bench_perception(const BenchSetup& setup);
/// The state estimator against the truth of simulated leaps on level ground.
/// @param jumps How many; twenty make a run.
[[nodiscard]] nlohmann::ordered_json bench_estimator(const BenchSetup& setup, int jumps);
/// Estimator and control tick in a simulated run, the MPC apart.
[[nodiscard]] nlohmann::ordered_json bench_tick(const BenchSetup& setup);
/// Simulation of a jump from standing to rest, on true terrain and with the camera.
[[nodiscard]] nlohmann::ordered_json bench_sim(const BenchSetup& setup);

/// Encoding and decoding of ten joints, CPU time of each out of batches of a hundred.
[[nodiscard]] nlohmann::ordered_json bench_wire();

}  // namespace hopscotch::apps
