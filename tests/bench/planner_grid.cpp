/// Makes config/bench/planner_targets.csv, in two steps:
///   planner_grid reach [START]   prints the targets of a fine grid that Ipopt solves from any of
///                                five guesses; START (stand, low or moving) restricts it
///   planner_grid choose N        sorts such a list from the standard input and prints N of it,
///                                spread evenly, below the names of the columns
/// The chain solver has no say in what counts as reachable. Five minutes of a core.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "core/config_reader.hpp"
#include "planner/ipopt_problem.hpp"
#include "planner/landing_phase.hpp"
#include "planner/planar_task.hpp"
#include "planner/step_target.hpp"
#include "planner/warm_start.hpp"

namespace {

using namespace hopscotch;           // NOLINT: a program of one file
using namespace hopscotch::planner;  // NOLINT

/// An attempt that ends further from feasible than this is not followed by one from elsewhere.
constexpr double kHopeless = 0.1;

struct Entry {
  double distance = 0.0;
  double height = 0.0;
  StartKind start = StartKind::stand;
};

class Grid {
 public:
  explicit Grid(const std::filesystem::path& folder)
      : robot_(model::RobotParameters::load(folder / "robots" / "hector.yaml")),
        root_(core::ConfigReader::from_file(folder / "hopscotch.yaml")),
        posture_(model::StandPosture::load(root_.section("model").section("stand_posture"))),
        model_(robot_, PlannerConfig::load(root_.section("planner"))),
        layout_(model_.config.steps) {}

  [[nodiscard]] bool is_reachable(const Entry& entry) const {
    const core::Result<PlanarTask> task = task_of(entry);
    if (!task) return false;
    constexpr std::array<std::array<double, 2>, 5> kStarts{
        {{0.0, 0.0}, {-0.05, 0.0}, {0.05, 0.0}, {0.0, 0.05}, {0.0, -0.05}}};
    for (const auto& [ahead, up] : kStarts) {
      const SolveOutcome outcome = solve(*task, guess(*task, ahead, up));
      if (outcome.status == SolveStatus::solved && outcome.violation < 1e-3) return true;
      if (outcome.violation > kHopeless) return false;
    }
    return false;
  }

 private:
  [[nodiscard]] core::Result<PlanarTask> task_of(const Entry& entry) const {
    const auto start = start_state(entry.start, robot_, posture_);
    if (!start) return core::Refusal{core::Reason::out_of_reach, "start"};
    return planar_task(model_,
                       {.start = *start,
                        .target = step_target({.distance = entry.distance,
                                               .height = entry.height,
                                               .edge = default_edge(entry.distance, entry.height)},
                                              robot_),
                        .final_posture = posture_});
  }
  /// The closed-form guess for a target a little beside.
  [[nodiscard]] Eigen::VectorXd guess(PlanarTask task, double ahead, double up) const {
    task.distance += ahead;
    task.height += up;
    return kinematic_guess(model_, task, layout_);
  }
  [[nodiscard]] SolveOutcome solve(const PlanarTask& task, const Eigen::VectorXd& start) const {
    BlockList blocks;
    add_takeoff(model_, task, layout_, blocks);
    add_flight(model_, task, layout_, blocks);
    add_landing(model_, task, layout_, blocks);
    return solve_with_ipopt({layout_.size(), std::move(blocks)},
                            decision_bounds(model_, task, layout_), decision_sizes(layout_),
                            {start}, {model_.config.iterations_max, model_.config.tolerance});
  }

  model::RobotParameters robot_;
  core::ConfigReader root_;
  model::StandPosture posture_;
  PlanarModel model_;
  DecisionLayout layout_;
};

std::vector<Entry> candidates(StartKind start) {
  std::vector<Entry> all;
  for (int up = -30; up <= 25; up += 5) {
    for (int ahead = 150; ahead <= 600; ahead += 20) {
      all.push_back({0.001 * ahead, 0.01 * up, start});
    }
  }
  return all;
}

int reach(const std::string& only) {
  const Grid grid(std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config");
  for (const StartKind start : {StartKind::stand, StartKind::low, StartKind::moving}) {
    if (!only.empty() && only != start_kind_name(start)) continue;
    for (const Entry& entry : candidates(start)) {
      if (!grid.is_reachable(entry)) continue;
      std::printf("%.3f,%.2f,%s\n", entry.distance, entry.height,
                  std::string(start_kind_name(start)).c_str());
      std::fflush(stdout);
    }
  }
  return EXIT_SUCCESS;
}

int choose(std::size_t wanted) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(std::cin, line);) lines.push_back(line);
  if (lines.size() < wanted) {
    std::fprintf(stderr, "planner_grid: only %zu targets are reachable\n", lines.size());
    return EXIT_FAILURE;
  }
  std::sort(lines.begin(), lines.end());
  std::printf("distance_m,height_m,start\n");
  for (std::size_t i = 0; i < wanted; ++i) {
    std::printf("%s\n", lines[i * lines.size() / wanted].c_str());
  }
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "reach") return reach(argc > 2 ? argv[2] : "");
  if (what == "choose" && argc == 3) return choose(std::strtoul(argv[2], nullptr, 10));
  std::fprintf(stderr, "usage: planner_grid reach [START] | planner_grid choose N\n");
  return EXIT_FAILURE;
}
