#include <algorithm>
#include <string>
#include <vector>

#include "apps/bench.hpp"
#include "apps/bench_targets.hpp"
#include "apps/flight_trial.hpp"
#include "apps/run_result.hpp"
#include "apps/shipped_jumps.hpp"
#include "sim/random.hpp"

namespace hopscotch::apps {

using Json = nlohmann::ordered_json;

namespace {

/// Landings farther from their target are named one by one [m].
constexpr double kLandingErrorWanted = 0.02;

std::vector<BenchTarget> standing_targets() {
  std::vector<BenchTarget> standing;
  for (const BenchTarget& target : read_targets()) {
    if (target.start == planner::StartKind::stand) standing.push_back(target);
  }
  return standing;
}

/// Targets moved by up to half of the grid that they come from; level ones stay level.
std::vector<BenchTarget> drawn(const std::vector<BenchTarget>& targets,
                               const FlightSample& sample) {
  constexpr double kAhead = 0.010;  // [m]
  constexpr double kUp = 0.025;     // [m]
  sim::Random random(sample.seed);
  std::vector<BenchTarget> chosen;
  for (int i = 0; i < sample.flights; ++i) {
    const double share = 0.5 * (random.uniform() + 1.0);
    BenchTarget target =
        targets[static_cast<std::size_t>(share * static_cast<double>(targets.size()))];
    target.distance += kAhead * random.uniform();
    const double up = kUp * random.uniform();
    if (target.height != 0.0) target.height += up;
    chosen.push_back(target);
  }
  return chosen;
}

struct Tally {
  int planned = 0;
  int landed = 0;
  int within = 0;
  std::vector<double> error;  ///< Of those that did not fall [m].
  Json others = Json::array();

  void note(const BenchTarget& target, const FlownJump& flown) {
    const bool fell = flown.jump.outcome == JumpOutcome::fell;
    const bool close = !fell && flown.landing_error <= kLandingErrorWanted;
    if (!fell) error.push_back(flown.landing_error);
    if (flown.jump.outcome == JumpOutcome::landed) ++landed;
    if (flown.jump.outcome == JumpOutcome::landed && close) {
      ++within;
      return;
    }
    Json row{{"distance_m", target.distance},
             {"height_m", target.height},
             {"outcome", jump_outcome_name(flown.jump.outcome)}};
    if (!fell) row["landing_error_m"] = flown.landing_error;
    if (!flown.jump.reason.empty()) row["reason"] = flown.jump.reason;
    others.push_back(row);
  }
};

}  // namespace

nlohmann::ordered_json bench_flights(const BenchSetup& setup, const FlightSample& sample) {
  planner::JumpPlanner planner(setup.config.planner, setup.robot,
                               shipped_jumps(setup.robot.name, setup.config.planner.steps));
  const std::vector<BenchTarget> standing = standing_targets();
  const std::vector<BenchTarget> targets =
      sample.seed == 0 ? spread(standing, static_cast<std::size_t>(sample.flights))
                       : drawn(standing, sample);
  Tally tally;
  for (const BenchTarget& target : targets) {
    const core::Result<core::JumpPlan> plan = planner.plan(request_for(setup, target));
    if (!plan) {
      tally.others.push_back({{"distance_m", target.distance},
                              {"height_m", target.height},
                              {"outcome", "not planned"},
                              {"reason", plan.error().text()}});
      continue;
    }
    ++tally.planned;
    tally.note(target, fly({*plan, step_of(target), setup.config, setup.robot}));
  }
  return {{"n", targets.size()},
          {"planned", tally.planned},
          {"landed", tally.landed},
          {"landed_within_2_cm", tally.within},
          {"landing_error_m", percentile_group(tally.error, 1.0)},
          {"others", tally.others}};
}

}  // namespace hopscotch::apps
