#include <algorithm>
#include <string>
#include <vector>

#include "apps/bench.hpp"
#include "apps/bench_targets.hpp"
#include "apps/flight_trial.hpp"
#include "apps/run_result.hpp"
#include "apps/shipped_jumps.hpp"

namespace hopscotch::apps {

using Json = nlohmann::ordered_json;

namespace {

/// Landings farther from their target are named one by one [m].
constexpr double kLandingErrorWanted = 0.02;

/// `count` of the targets from standing, spread evenly over the file. Without those whose step up
/// begins under the toes: there is nothing to stand on.
std::vector<BenchTarget> sampled(const model::RobotParameters& robot, int count) {
  constexpr double kToeRoom = 0.01;  // [m]
  const double toe = 0.5 * (robot.toe + robot.heel) + kToeRoom;
  std::vector<BenchTarget> standing;
  for (const BenchTarget& target : read_targets()) {
    const bool flyable = target.height == 0.0 || step_of(target).edge > toe;
    if (flyable && target.start == planner::StartKind::stand) standing.push_back(target);
  }
  std::vector<BenchTarget> chosen;
  const std::size_t wanted = std::min(static_cast<std::size_t>(count), standing.size());
  for (std::size_t i = 0; i < wanted; ++i) {
    chosen.push_back(standing[i * standing.size() / wanted]);
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

nlohmann::ordered_json bench_flights(const BenchSetup& setup, int flights) {
  planner::JumpPlanner planner(setup.config.planner, setup.robot,
                               shipped_jumps(setup.robot.name, setup.config.planner.steps));
  const std::vector<BenchTarget> targets = sampled(setup.robot, flights);
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
