#include "apps/campaign/trial_run.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/explain.hpp"
#include "apps/installation.hpp"
#include "apps/report.hpp"
#include "apps/stopwatch.hpp"
#include "model/rigid_body.hpp"

namespace hopscotch::apps::campaign {

namespace {

std::int16_t millimetres(double metres) {
  constexpr double kMost = std::numeric_limits<std::int16_t>::max();
  return static_cast<std::int16_t>(std::clamp(std::round(1e3 * metres), -kMost, kMost));
}

/// Keeps the CoM at the path's period.
class PathKeeper {
 public:
  PathKeeper(const model::RobotParameters& robot, TrialResult& result)
      : robot_(robot), result_(result) {}

  void add(const core::RobotState& truth) {
    if (truth.stamp.seconds() < next_) return;
    next_ += TrialResult::kPathPeriod;
    const Eigen::Vector3d p_WG = model::composite_body(robot_, truth).p_WG;
    result_.path.push_back({millimetres(p_WG.x()), millimetres(p_WG.z())});
  }

 private:
  const model::RobotParameters& robot_;
  TrialResult& result_;
  double next_ = 0.0;
};

RunResult run_to_end(const RunRequest& request,
                     const std::function<void(const TickRecord&)>& observe) {
  LockstepRun run(request);
  while (run.step(observe)) {
  }
  return run.result();
}

/// Runs a trial with a log into a run folder; without the report.
RunResult log_trial(const TrialMaker& maker, std::int64_t index,
                    const std::filesystem::path& folder) {
  const Stopwatch watch;
  const TrialSetup setup = maker.setup(index);
  const RunRequest request = maker.request(setup, maker.spec().eyes);
  const RunSources sources = maker.sources(setup);
  const std::uint64_t id = run_identity(sources, request);
  RunRecorder recorder(folder, id, request, sources);
  RunResult result = run_to_end(request, [&](const TickRecord& tick) { recorder.record(tick); });
  result.run_id = hex_text(id);
  result.program = std::string(program_version());
  result.timing.real_time_factor = 1e3 * result.duration / watch.milliseconds();
  recorder.finish(result);
  return result;
}

/// How a run ended is not why. The few that fail are run again with a log, which tells.
void explain_failure(const TrialMaker& maker, TrialResult& result) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() /
      ("hopscotch-trial-" + std::to_string(getpid()) + "-" + std::to_string(result.index));
  log_trial(maker, result.index, folder);
  const Clue first = explain_run({folder}).first;
  fs::remove_all(folder);
  if (first.cause == apps::Cause::none || first.cause == apps::Cause::unknown) return;
  result.sentence = first.sentence + "; then " + result.cause + ": " + result.sentence;
  result.cause = cause_code(first.cause);
}

}  // namespace

TrialResult run_trial(const TrialMaker& maker, std::int64_t index) {
  const Stopwatch watch;
  const TrialSetup setup = maker.setup(index);
  const RunRequest request = maker.request(setup, maker.spec().eyes);
  TrialResult result;
  result.index = index;
  result.seed = setup.seed;
  result.values = setup.values;
  PathKeeper keeper(request.plant_robot, result);
  const bool keep = place_of(index, maker.spec().cells()).repetition < kPathsPerCell;
  const RunResult run = run_to_end(request, [&](const TickRecord& tick) {
    if (keep) keeper.add(tick.truth.state);
  });
  include_run(run, result);
  if (run.outcome == RunOutcome::refused) {
    const bool saw_truth = request.eyes == Eyes::truth;
    const RunResult truth = saw_truth ? run : run_to_end(maker.request(setup, Eyes::truth), {});
    result.truth_outcome = run_outcome_name(truth.outcome);
  }
  if (!result.succeeded()) explain_failure(maker, result);
  result.wall = 1e-3 * watch.milliseconds();
  return result;
}

RunResult record_trial(const TrialMaker& maker, std::int64_t index,
                       const std::filesystem::path& folder) {
  RunResult result = log_trial(maker, index, folder);
  write_report(folder);
  return result;
}

}  // namespace hopscotch::apps::campaign
