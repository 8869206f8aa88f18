#pragma once

#include <vector>

#include "planner/chain_solver.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// A jump that was solved and certified, with all that another solve close by may start from.
struct KnownJump {
  LinkState start;
  double distance = 0.0;  ///< [m]
  double height = 0.0;    ///< [m]
  ChainSolution solution;
  std::vector<StepCorrection>
      correction;  ///< That the solution holds with; of all steps, in order.
};

/// The motion of a known jump, for the target of `task`.
[[nodiscard]] PlanarMotion motion_of(const KnownJump& jump, const PlanarModel& model,
                                     const PlanarTask& task, const DecisionLayout& layout);

}  // namespace hopscotch::planner
