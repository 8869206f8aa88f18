#include "planner/jump_program.hpp"

#include <utility>

#include "planner/flight_phase.hpp"
#include "planner/landing_phase.hpp"
#include "planner/takeoff_phase.hpp"

namespace hopscotch::planner {

NonlinearProgram jump_program(const PlanarModel& model, const PlanarTask& task,
                              const DecisionLayout& layout, StepCorrections corrections) {
  BlockList blocks;
  if (!layout.steps().landed()) {
    add_takeoff(model, task, layout, blocks, corrections);
    add_flight(model, task, layout, blocks, corrections);
  }
  add_landing(model, task, layout, blocks, corrections);
  return {layout.size(), std::move(blocks)};
}

}  // namespace hopscotch::planner
