#include "apps/bench_targets.hpp"

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "apps/installation.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

std::vector<BenchTarget> spread(const std::vector<BenchTarget>& targets, std::size_t count) {
  std::vector<BenchTarget> chosen;
  const std::size_t wanted = std::min(count, targets.size());
  for (std::size_t i = 0; i < wanted; ++i) {
    chosen.push_back(targets[i * targets.size() / wanted]);
  }
  return chosen;
}

planner::StepRequest step_of(const BenchTarget& target) {
  return {.distance = target.distance,
          .height = target.height,
          .edge = planner::default_edge(target.distance, target.height)};
}

std::vector<BenchTarget> read_targets() {
  const std::filesystem::path path = config_directory() / "bench" / "planner_targets.csv";
  std::ifstream file(path);
  if (!file) throw core::ConfigError(path.string() + ": cannot be read");
  std::vector<BenchTarget> targets;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (number == 1) continue;  // names of the columns
    std::istringstream fields(line);
    BenchTarget target;
    char comma = ' ';
    std::string start;
    fields >> target.distance >> comma >> target.height >> comma >> start;
    const std::optional<planner::StartKind> kind = planner::start_kind_from(start);
    if (!fields || !kind) {
      throw core::ConfigError(path.string() + ":" + std::to_string(number) +
                              ": must be distance,height,start");
    }
    target.start = *kind;
    targets.push_back(target);
  }
  return targets;
}

planner::PlanRequest request_for(const BenchSetup& setup, const BenchTarget& target) {
  const model::StandPosture& posture = setup.config.stand_posture;
  const std::optional<core::RobotState> start =
      planner::start_state(target.start, setup.robot, posture);
  if (!start) throw core::ConfigError("model.stand_posture cannot be taken");
  return {.start = *start,
          .target = planner::step_target(step_of(target), setup.robot),
          .final_posture = posture};
}

}  // namespace hopscotch::apps
