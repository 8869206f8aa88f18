#pragma once

#include <vector>

#include "core/jump_plan.hpp"
#include "planner/planar_jump.hpp"
#include "planner/side_step.hpp"

namespace hopscotch::planner {

/// Knots of a jump to the side or with a turn: the planar motion shifted and turned by `SideStep`.
/// The legs reach the soles exactly and the CoM of the whole robot follows the shifted path; each
/// foot's load carries what the path asks for, with no roll of the trunk. What stays out: the small
/// roll momentum of legs that swing to the side in flight.
class SideLift {
 public:
  SideLift(const PlanarModel& model, const PlanarMotion& motion, const SideStep& step);

  /// @param[out] knot In S. @return false if a leg cannot reach.
  [[nodiscard]] bool lift(const PlanarKnot& from, core::JumpKnot& knot) const;

  /// Vertical angular momentum of the lifted robot at the flight instants of SideStep
  /// [kg·m^2/s]. @return empty if a leg cannot reach.
  [[nodiscard]] std::vector<double> flight_momentum() const;

 private:
  [[nodiscard]] bool place(const PlanarInstant& now, const SideShift& shift,
                           core::JumpKnot& knot) const;
  void set_efforts(const PlanarInstant& now, const SideShift& shift, const core::JumpKnot& middle,
                   core::JumpKnot& knot) const;

  const PlanarModel& model_;
  const PlanarMotion& motion_;
  const SideStep& step_;
};

}  // namespace hopscotch::planner
