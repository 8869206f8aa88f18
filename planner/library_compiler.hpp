#pragma once

#include <functional>

#include "model/robot_parameters.hpp"
#include "model/stand_posture.hpp"
#include "planner/jump_library.hpp"
#include "planner/planner_config.hpp"

namespace hopscotch::planner {

/// What a library holds: every target of the grid that is planned and certified, from each start
/// state, the edge of the ground where `default_edge` puts it.
struct LibraryGrid {
  double distance_from = 0.15;       ///< [m]
  double distance_to = 0.65;         ///< [m]
  double distance_step = 0.03;       ///< [m]
  double height_from = -0.30;        ///< [m]
  double height_to = 0.25;           ///< [m]
  double height_step = 0.025;        ///< From standing [m].
  double other_height_step = 0.025;  ///< From other start states [m].
};

/// Solves all jumps of the grid, those that fail once more from solved neighbours until no more are
/// found; then looks whether neighbours lead to cheaper ones (docs/decisions/0079).
/// @param progress Called with the share that is done.
/// @throws std::invalid_argument if the robot cannot stand in `posture`.
[[nodiscard]] JumpLibrary compile_library(const PlannerConfig& config,
                                          const model::RobotParameters& robot,
                                          const model::StandPosture& posture,
                                          const LibraryGrid& grid,
                                          const std::function<void(double)>& progress);

}  // namespace hopscotch::planner
