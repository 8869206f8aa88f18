#pragma once

#include "planner/nonlinear_program.hpp"
#include "planner/planar_jump.hpp"
#include "planner/step_shift.hpp"

namespace hopscotch::planner {

/// The nonlinear program of a jump, eqs. (2)-(12), as blocks of rows: for Ipopt.
[[nodiscard]] NonlinearProgram jump_program(const PlanarModel& model, const PlanarTask& task,
                                            const DecisionLayout& layout,
                                            StepCorrections corrections = {});

}  // namespace hopscotch::planner
