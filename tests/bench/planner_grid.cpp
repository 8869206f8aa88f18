/// Prints targets for config/bench/planner_targets.csv (without its first line): those of a fine
/// grid that Ipopt solves from any of five guesses. An argument (stand, low or moving) restricts
/// the start state. What the chain solver leaves violated by more than `kHopeless` is not tried
/// with Ipopt: those jumps are far outside, and five refusals of Ipopt take seconds. Ten minutes of
/// a core.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/config_reader.hpp"
#include "planner/chain_solver.hpp"
#include "planner/ipopt_problem.hpp"
#include "planner/landing_phase.hpp"
#include "planner/planar_task.hpp"
#include "planner/step_target.hpp"
#include "planner/warm_start.hpp"

namespace {

using namespace hopscotch;           // NOLINT: a program of one file
using namespace hopscotch::planner;  // NOLINT

constexpr double kHopeless = 0.05;

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
    if (is_hopeless(*task)) return false;
    constexpr std::array<std::array<double, 2>, 5> kStarts{
        {{0.0, 0.0}, {-0.05, 0.0}, {0.05, 0.0}, {0.0, 0.05}, {0.0, -0.05}}};
    return std::any_of(kStarts.begin(), kStarts.end(), [&](const auto& shift) {
      return solves(*task, guess(*task, shift[0], shift[1]));
    });
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
  [[nodiscard]] bool is_hopeless(const PlanarTask& task) const {
    ChainSolver solver(layout_);
    const ChainProblem problem(model_, task, layout_);
    return solver.solve(problem, guess(task, 0.0, 0.0), {model_.config.iterations_max, 1e-3})
               .violation > kHopeless;
  }
  /// The closed-form guess for a target a little beside.
  [[nodiscard]] Eigen::VectorXd guess(PlanarTask task, double ahead, double up) const {
    task.distance += ahead;
    task.height += up;
    return kinematic_guess(model_, task, layout_);
  }
  [[nodiscard]] bool solves(const PlanarTask& task, const Eigen::VectorXd& start) const {
    BlockList blocks;
    add_takeoff(model_, task, layout_, blocks);
    add_flight(model_, task, layout_, blocks);
    add_landing(model_, task, layout_, blocks);
    const SolveOutcome outcome = solve_with_ipopt(
        {layout_.size(), std::move(blocks)}, decision_bounds(model_, task, layout_),
        decision_sizes(layout_), {start}, {model_.config.iterations_max, model_.config.tolerance});
    return outcome.status == SolveStatus::solved && outcome.violation < 1e-3;
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

}  // namespace

int main(int argc, char** argv) {
  const Grid grid(std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config");
  for (const StartKind start : {StartKind::stand, StartKind::low, StartKind::moving}) {
    if (argc > 1 && argv[1] != start_kind_name(start)) continue;
    for (const Entry& entry : candidates(start)) {
      if (!grid.is_reachable(entry)) continue;
      std::printf("%.3f,%.2f,%s\n", entry.distance, entry.height,
                  std::string(start_kind_name(start)).c_str());
      std::fflush(stdout);
    }
  }
  return EXIT_SUCCESS;
}
