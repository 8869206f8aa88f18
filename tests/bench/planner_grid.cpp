/// Makes config/bench/planner_targets.csv, in two steps:
///   planner_grid reach [START]   prints the targets of a fine grid for which Ipopt, from any of
///                                five guesses, finds a motion that is certified; START (stand, low
///                                or moving) restricts it
///   planner_grid choose N        sorts such a list from the standard input and prints N of it,
///                                spread evenly, below the names of the columns
/// The chain solver has no say in what counts as reachable. Ten minutes of a core.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "planner/certificate.hpp"
#include "tests/bench/grid_target.hpp"

namespace {

using namespace hopscotch;           // NOLINT: a program of one file
using namespace hopscotch::planner;  // NOLINT

/// An attempt that ends further from feasible than this is not followed by one from elsewhere.
constexpr double kHopeless = 0.1;

/// The closed-form guess for a target a little beside.
Eigen::VectorXd guess_beside(const GridProblems& problems, PlanarTask task, double ahead,
                             double up) {
  task.distance += ahead;
  task.height += up;
  return kinematic_guess(problems.model, task, problems.layout);
}

/// Keeps the motion the physical limits between its knots, too?
bool is_certified(const GridProblems& problems, const PlanarTask& task,
                  const SolveOutcome& outcome) {
  constexpr double kTolerance = 1e-3;
  const PlanarMotion motion =
      motion_from_decision(problems.model, task, problems.layout, outcome.x);
  return certify(problems.model, task, motion).certificate.binding().margin >= -kTolerance;
}

bool is_reachable(const GridProblems& problems, const GridTarget& target) {
  const core::Result<PlanarTask> task = problems.task_of(target);
  if (!task) return false;
  const ShankRange shank = landed_shank_range(problems.model, *task);
  if (task->final_posture[model::kShank] < shank.lower) return false;  // no motion changes that
  constexpr std::array<std::array<double, 2>, 5> kStarts{
      {{0.0, 0.0}, {-0.05, 0.0}, {0.05, 0.0}, {0.0, 0.05}, {0.0, -0.05}}};
  for (const auto& [ahead, up] : kStarts) {
    const SolveOutcome outcome =
        problems.by_ipopt(*task, guess_beside(problems, *task, ahead, up), problems.options());
    const bool solved = outcome.status == SolveStatus::solved && outcome.violation < 1e-3;
    if (solved && is_certified(problems, *task, outcome)) return true;
    if (outcome.violation > kHopeless) return false;
  }
  return false;
}

std::vector<GridTarget> candidates(StartKind start) {
  std::vector<GridTarget> all;
  for (int up = -30; up <= 25; up += 5) {
    for (int ahead = 150; ahead <= 600; ahead += 18) {
      all.push_back({0.001 * ahead, 0.01 * up, start});
    }
  }
  return all;
}

int reach(const std::string& only) {
  const GridProblems problems(std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config");
  for (const StartKind start : {StartKind::stand, StartKind::low, StartKind::moving}) {
    if (!only.empty() && only != start_kind_name(start)) continue;
    for (const GridTarget& target : candidates(start)) {
      if (!is_reachable(problems, target)) continue;
      std::printf("%.3f,%.2f,%s\n", target.distance, target.height,
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
