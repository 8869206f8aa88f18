#include "planner/library_compiler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "planner/corrected_solver.hpp"
#include "planner/ipopt_problem.hpp"
#include "planner/jump_planner.hpp"
#include "planner/jump_program.hpp"
#include "planner/planar_task.hpp"
#include "planner/step_target.hpp"
#include "planner/warm_start.hpp"

namespace hopscotch::planner {

namespace {

struct Cell {
  core::RobotState start;
  double distance = 0.0;  ///< [m]
  double height = 0.0;    ///< [m]
  std::optional<KnownJump> jump;
  double cost = kUnbounded;  ///< Of the jump.
};

JumpLibrary library_of(const std::string& robot, const StepCounts& steps,
                       const std::vector<Cell>& cells) {
  JumpLibrary library(robot, steps);
  for (const Cell& cell : cells) {
    if (cell.jump) library.add(*cell.jump);
  }
  return library;
}

/// from, from + step ... up to `to`.
std::vector<double> range(double from, double to, double step) {
  std::vector<double> values;
  const int last = static_cast<int>(std::floor((to - from) / step + 1e-6));
  for (int i = 0; i <= last; ++i) values.push_back(from + step * i);
  return values;
}

void add_cells(const core::RobotState& start, double height_step, const LibraryGrid& grid,
               std::vector<Cell>& cells) {
  for (const double distance : range(grid.distance_from, grid.distance_to, grid.distance_step)) {
    for (const double height : range(grid.height_from, grid.height_to, height_step)) {
      cells.push_back({start, distance, height, std::nullopt});
    }
  }
}

/// Solves the jumps of cells, one after the other.
class Compiler {
 public:
  Compiler(const PlannerConfig& config, const model::RobotParameters& robot,
           const model::StandPosture& posture, std::shared_ptr<const JumpLibrary> library)
      : robot_(robot),
        posture_(posture),
        library_(std::move(library)),
        model_(robot, config),
        planner_(config, robot, library_) {}

  /// Finds a jump for a cell that has none. @return whether it did.
  bool solve(Cell& cell) {
    return (is_solved(request(cell, cell.distance, cell.height)) || walk_to(cell)) &&
           keep(planner_, cell);
  }

  /// Looks for a cheaper jump than the cell has: solutions are local, and those of neighbours may
  /// lead to a better one. @return whether there was one.
  bool improve(Cell& cell) {
    constexpr std::size_t kNeighbours = 7;  // with the cell's own
    const PlanRequest wanted = request(cell, cell.distance, cell.height);
    const core::Result<PlanarTask> task = planar_task(model_, wanted);
    if (!task) return false;
    bool better = false;
    for (const KnownJump* from : library_->nearest(*task, kNeighbours)) {
      better = (walk(cell, from->distance, from->height, 1) && keep(planner_, cell)) || better;
    }
    return better;
  }

  /// Looks for a cheaper jump, or one at all, from where Ipopt ends: from the same closed-form
  /// guess it takes other ways. @return whether there was one.
  bool improve_by_ipopt(Cell& cell) {
    PlanRequest wanted = request(cell, cell.distance, cell.height);
    const core::Result<PlanarTask> task = planar_task(model_, wanted);
    if (!task) return false;
    const DecisionLayout layout(model_.config.steps);
    const SolveOutcome outcome = solve_with_ipopt(
        jump_program(model_, *task, layout), decision_bounds(model_, *task, layout),
        decision_sizes(layout), {kinematic_guess(model_, *task, layout)},
        {model_.config.iterations_max, model_.config.tolerance});
    if (outcome.status != SolveStatus::solved) return false;
    CorrectedSolver solver(layout);
    const SolvedMotion solved = solver.solve(model_, *task, outcome.x);
    if (!is_acceptable(solved.outcome)) return false;
    auto alone = std::make_shared<JumpLibrary>(robot_.name, model_.config.steps);
    alone->add(solver.known(*task, solved));
    JumpPlanner near(model_.config, robot_, alone);
    if (!near.plan(wanted) || near.rung() != PlanRung::neighbour) return false;
    return keep(near, cell);
  }

 private:
  [[nodiscard]] PlanRequest request(const Cell& cell, double distance, double height) const {
    const StepRequest step{
        .distance = distance, .height = height, .edge = default_edge(distance, height)};
    return {.start = cell.start, .target = step_target(step, robot_), .final_posture = posture_};
  }

  /// A planner's last jump, where it is clearly cheaper than the cell's.
  static bool keep(const JumpPlanner& planner, Cell& cell) {
    constexpr double kCheaper = 1e-4;  // relative
    if (planner.cost() > (1.0 - kCheaper) * cell.cost) return false;
    cell.jump = *planner.last();
    cell.cost = planner.cost();
    return true;
  }

  [[nodiscard]] bool is_solved(const PlanRequest& request) {
    return planner_.plan(request) && (planner_.rung() != PlanRung::library);
  }

  /// At the border of what is possible the way from a guess to the solution is often lost: from a
  /// jump nearby, known or found beside the cell, by small steps.
  bool walk_to(const Cell& cell) {
    constexpr std::size_t kOrigins = 4;
    constexpr int kSteps = 8;
    constexpr std::array<double, 4> kBeside{-0.010, -0.005, 0.005, 0.010};  // [m]
    const PlanRequest wanted = request(cell, cell.distance, cell.height);
    const core::Result<PlanarTask> task = planar_task(model_, wanted);
    if (!task) return false;
    const std::vector<const KnownJump*> known = library_->nearest(*task, kOrigins);
    if (known.empty()) return false;  // as in the first pass, and far beyond what is possible
    for (const KnownJump* origin : known) {
      if (walk(cell, origin->distance, origin->height, kSteps)) return true;
    }
    return std::any_of(kBeside.begin(), kBeside.end(), [&](double beside) {
      return walk(cell, cell.distance + beside, cell.height, kSteps);
    });
  }

  bool walk(const Cell& cell, double distance, double height, int steps) {
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      PlanRequest next = request(cell, std::lerp(distance, cell.distance, share),
                                 std::lerp(height, cell.height, share));
      if (i > 0) next.guess = StartGuess::previous;
      if (!is_solved(next)) return false;
    }
    return true;
  }

  const model::RobotParameters& robot_;
  const model::StandPosture& posture_;
  std::shared_ptr<const JumpLibrary> library_;
  PlanarModel model_;
  JumpPlanner planner_;
};

}  // namespace

JumpLibrary compile_library(const PlannerConfig& config, const model::RobotParameters& robot,
                            const model::StandPosture& posture, const LibraryGrid& grid,
                            const std::function<void(double)>& progress) {
  constexpr int kPasses = 3;
  constexpr int kImprovements = 4;
  std::vector<Cell> cells;
  for (const StartKind kind : {StartKind::stand, StartKind::low, StartKind::moving}) {
    const std::optional<core::RobotState> start = start_state(kind, robot, posture);
    if (!start) throw std::invalid_argument(robot.name + " cannot stand as configured");
    const double step = kind == StartKind::stand ? grid.height_step : grid.other_height_step;
    add_cells(*start, step, grid, cells);
  }
  const double rounds = (kPasses + kImprovements) * static_cast<double>(cells.size());
  double done = 0.0;
  for (int pass = 0; pass < kPasses + kImprovements; ++pass) {
    Compiler compiler(
        config, robot, posture,
        std::make_shared<const JumpLibrary>(library_of(robot.name, config.steps, cells)));
    int changes = 0;
    for (Cell& cell : cells) {
      progress(++done / rounds);
      const bool solving = pass < kPasses;
      if (pass == kPasses) changes += static_cast<int>(compiler.improve_by_ipopt(cell));
      if (cell.jump.has_value() == solving) continue;
      changes += static_cast<int>(solving ? compiler.solve(cell) : compiler.improve(cell));
    }
    if (changes == 0 && pass >= kPasses) break;
  }
  return library_of(robot.name, config.steps, cells);
}

}  // namespace hopscotch::planner
