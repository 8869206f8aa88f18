#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <span>

#include "apps/bench.hpp"
#include "apps/lockstep_run.hpp"
#include "apps/run_recorder.hpp"
#include "apps/stopwatch.hpp"
#include "control/wrench_qp_record.hpp"
#include "core/config_reader.hpp"
#include "core/input_file.hpp"

namespace hopscotch::apps {

namespace {

/// Solve times of one recorded problem, the middle of three passes for the cold ones.
struct RecordedTimes {
  std::vector<double> cold_ms;
  std::vector<double> warm_ms;
  double objective_error = 0.0;
  int failures = 0;
};

constexpr int kPasses = 3;

double middle(std::array<double, kPasses> samples) {
  std::sort(samples.begin(), samples.end());
  return samples[kPasses / 2];
}

void solve_recorded(const control::WrenchQpRecord& record, control::QpSolver& cold_solver,
                    control::QpSolver& warm_solver, RecordedTimes& times) {
  std::array<double, kPasses> cold_ms{};
  bool solved = true;
  for (double& sample : cold_ms) {
    const Stopwatch watch(TimeOf::thread);
    solved = cold_solver.solve_cold(record.qp) == control::QpStatus::solved && solved;
    sample = watch.milliseconds();
  }
  times.cold_ms.push_back(middle(cold_ms));
  const Stopwatch watch(TimeOf::thread);
  solved = warm_solver.solve_warm(record.qp, record.map) == control::QpStatus::solved && solved;
  times.warm_ms.push_back(watch.milliseconds());
  if (!solved) ++times.failures;
  const double error =
      std::abs(cold_solver.objective() - record.objective) / (1.0 + std::abs(record.objective));
  times.objective_error = std::max(times.objective_error, error);
}

std::vector<control::WrenchQpRecord> read_records(const std::filesystem::path& file) {
  const std::string bytes = core::read_input_file(file);
  const auto records =
      control::decode_wrench_qps(std::as_bytes(std::span<const char>(bytes.data(), bytes.size())));
  if (!records) throw core::ConfigError(file.string() + ": is no file of recorded QPs");
  return *records;
}

/// The problems of leaps on level ground as the MPC is asked them, each with a reference optimum
/// far tighter than the solver's own tolerances.
std::vector<control::WrenchQpRecord> record_leaps(const BenchSetup& setup) {
  const control::QpTolerances& own = setup.config.control.wrench_mpc.tolerances;
  constexpr double kTighter = 1e-3;
  control::QpSolver reference({.iteration_cap = 3 * own.iteration_cap,
                               .gap = kTighter * own.gap,
                               .stationarity = kTighter * own.stationarity});
  std::vector<control::WrenchQpRecord> records;
  LockstepRun run(level_ground_run(setup, Eyes::truth));
  while (run.step([&](const TickRecord& tick) {
    if (!tick.events.mpc_ms) return;
    control::WrenchQpRecord record;
    record.qp = run.pipeline().mpc().qp();
    record.map = run.pipeline().mpc().warm_start_map();
    static_cast<void>(reference.solve_cold(record.qp));
    record.objective = reference.objective();
    records.push_back(record);
  })) {
  }
  return records;
}

}  // namespace

nlohmann::ordered_json bench_mpc(const BenchSetup& setup, const std::filesystem::path& qps) {
  const std::vector<control::WrenchQpRecord> records =
      qps.empty() ? record_leaps(setup) : read_records(qps);
  control::QpSolver cold_solver(setup.config.control.wrench_mpc.tolerances);
  control::QpSolver warm_solver(setup.config.control.wrench_mpc.tolerances);
  RecordedTimes times;
  for (const control::WrenchQpRecord& record : records) {
    solve_recorded(record, cold_solver, warm_solver, times);
  }
  return {{"n", records.size()},
          {"cold_us", percentile_group(times.cold_ms, 1e3)},
          {"warm_us", percentile_group(times.warm_ms, 1e3)},
          {"objective_error_max", times.objective_error},
          {"failures", times.failures}};
}

nlohmann::ordered_json bench_tick(const BenchSetup& setup) {
  const RunRequest request = level_ground_run(setup, Eyes::truth);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("hopscotch-bench-" + std::to_string(getpid()));
  LockstepRun run(request);
  std::vector<double> record_ms;
  {
    RunRecorder recorder(folder, 1, request, {});  // never finished: leaves nothing behind
    while (run.step([&](const TickRecord& tick) {
      const Stopwatch watch(TimeOf::thread);
      recorder.record(tick);
      record_ms.push_back(watch.milliseconds());
    })) {
    }
  }
  const LockstepRun::StageSamples& samples = run.samples();
  std::vector<double> tick_ms = samples.tick_ms;
  for (std::size_t i = 0; i < tick_ms.size(); ++i) tick_ms[i] += samples.estimator_ms.at(i);
  return {{"n", tick_ms.size()},
          {"tick_us", percentile_group(tick_ms, 1e3)},
          {"estimator_us", percentile_group(samples.estimator_ms, 1e3)},
          {"record_us", percentile_group(std::move(record_ms), 1e3)},
          {"allocations", samples.allocations}};
}

}  // namespace hopscotch::apps
