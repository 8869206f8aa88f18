#include "planner/library_compiler.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::planner {

namespace {

struct Cell {
  PlanRequest request;
  bool solved = false;
};

/// from, from + step ... up to `to`.
std::vector<double> range(double from, double to, double step) {
  std::vector<double> values;
  const int last = static_cast<int>(std::floor((to - from) / step + 1e-6));
  for (int i = 0; i <= last; ++i) values.push_back(from + step * i);
  return values;
}

void add_cells(StartKind kind, const model::RobotParameters& robot,
               const model::StandPosture& posture, const LibraryGrid& grid,
               std::vector<Cell>& cells) {
  const std::optional<core::RobotState> start = start_state(kind, robot, posture);
  if (!start) throw std::invalid_argument(robot.name + " cannot stand as configured");
  const double height_step = kind == StartKind::stand ? grid.height_step : grid.other_height_step;
  for (const double distance : range(grid.distance_from, grid.distance_to, grid.distance_step)) {
    for (const double height : range(grid.height_from, grid.height_to, height_step)) {
      const StepRequest step{
          .distance = distance, .height = height, .edge = default_edge(distance, height)};
      cells.push_back(
          {{.start = *start, .target = step_target(step, robot), .final_posture = posture}});
    }
  }
}

}  // namespace

JumpLibrary compile_library(const PlannerConfig& config, const model::RobotParameters& robot,
                            const model::StandPosture& posture, const LibraryGrid& grid,
                            const std::function<void(double)>& progress) {
  constexpr int kPasses = 3;
  std::vector<Cell> cells;
  for (const StartKind kind : {StartKind::stand, StartKind::low, StartKind::moving}) {
    add_cells(kind, robot, posture, grid, cells);
  }
  auto library = std::make_shared<const JumpLibrary>(robot.name, config.steps);
  double done = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    JumpPlanner planner(config, robot, library);
    JumpLibrary grown = *library;
    for (Cell& cell : cells) {
      progress(++done / (kPasses * static_cast<double>(cells.size())));
      if (cell.solved || !planner.plan(cell.request)) continue;
      if (planner.rung() != PlanRung::solved && planner.rung() != PlanRung::neighbour) continue;
      cell.solved = true;
      grown.add(*planner.last());
    }
    const bool complete = grown.jumps().size() == library->jumps().size();
    library = std::make_shared<const JumpLibrary>(std::move(grown));
    if (complete) break;
  }
  return *library;
}

}  // namespace hopscotch::planner
