#pragma once

#include <Eigen/Core>

#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// Closed-form kinematic guess of the whole jump as a decision vector: rest, a push to a lift-off
/// posture, a parabola with the legs drawn in, a touchdown posture and the way to the final one.
/// Postures follow from CoM and trunk pitch, rates from differences; no dynamics, no iteration.
[[nodiscard]] Eigen::VectorXd kinematic_guess(const PlanarModel& model, const PlanarTask& task,
                                              const DecisionLayout& layout);

}  // namespace hopscotch::planner
