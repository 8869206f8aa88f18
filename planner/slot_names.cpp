#include "planner/slot_names.hpp"

#include <array>

namespace hopscotch::planner {

namespace {

constexpr std::array<std::string_view, ChainLayout::kStanceRows> kStanceNames{
    "hip torque",
    "hip torque-speed line",
    "hip torque-speed line",
    "hip power",
    "knee torque",
    "knee torque-speed line",
    "knee torque-speed line",
    "knee power",
    "ankle torque",
    "ankle torque-speed line",
    "ankle torque-speed line",
    "ankle power",
    "normal force",
    "friction",
    "friction",
    "toe pressure",
    "heel pressure"};
constexpr std::array<std::string_view, kFlightDof> kJointNames{"hip range", "hip speed",
                                                               "ankle speed", "ankle range"};
constexpr std::array<std::string_view, ChainLayout::kClearanceRows> kClearanceNames{
    "toe clearance", "heel clearance", "shank clearance", "shank clearance", "knee clearance"};
constexpr std::array<std::string_view, 2> kTouchdownNames{"touchdown speed along",
                                                          "touchdown speed down"};
constexpr std::array<std::string_view, kFlightDof> kPitchNames{"shank pitch", "knee range",
                                                               "trunk pitch", "foot pitch"};
constexpr std::array<std::string_view, kFlightDof> kRateNames{"shank rate", "knee speed",
                                                              "trunk rate", "foot rate"};

template <std::size_t N>
std::string_view cyclic(const std::array<std::string_view, N>& names, int at, int period) {
  return names[static_cast<std::size_t>(at % period)];
}

/// Coordinates and rates of a knot: `dof` of each.
std::string_view knot_name(int at, int dof) {
  const int within = at % (2 * dof);
  return within < dof ? cyclic(kPitchNames, within, dof) : cyclic(kRateNames, within - dof, dof);
}

std::string_view variable_name(const DecisionLayout& layout, int at) {
  if (at == layout.landing_step()) return "landing time";
  if (layout.steps().landed()) return knot_name(at, kStanceDof);
  if (at < layout.flight(1)) return knot_name(at, kStanceDof);
  if (at < layout.touchdown_rates()) return knot_name(at - layout.flight(1), kFlightDof);
  if (at < layout.landing(1)) return cyclic(kRateNames, at - layout.touchdown_rates(), kStanceDof);
  if (at < layout.liftoff_com()) return knot_name(at - layout.landing(1), kStanceDof);
  if (at == layout.flight_step()) return "flight time";
  return "lift-off";
}

}  // namespace

std::string_view slot_name(const ChainLayout& layout, int slot) {
  const StepCounts& steps = layout.steps();
  if (slot < layout.takeoff_joints(0)) {
    return cyclic(kStanceNames, slot, ChainLayout::kStanceRows);
  }
  if (slot < layout.flight_rows(0)) {
    return cyclic(kJointNames, slot - layout.takeoff_joints(0), kStanceDof);
  }
  if (slot < layout.flight_joints(0)) {
    return cyclic(kStanceNames, slot - layout.flight_rows(0), ChainLayout::kFlightRows);
  }
  if (slot < layout.clearance(0)) {
    return cyclic(kJointNames, slot - layout.flight_joints(0), kFlightDof);
  }
  if (slot < layout.touchdown_speeds()) {
    return cyclic(kClearanceNames, slot - layout.clearance(0), ChainLayout::kClearanceRows);
  }
  if (slot < layout.landing_rows(0))
    return cyclic(kTouchdownNames, slot - layout.touchdown_speeds(), 2);
  if (slot < layout.landing_joints(0)) {
    return cyclic(kStanceNames, slot - layout.landing_rows(0), ChainLayout::kStanceRows);
  }
  if (slot < layout.landing_joints(steps.landing)) {
    return cyclic(kJointNames, slot - layout.landing_joints(0), kStanceDof);
  }
  return variable_name(layout.decision(), slot - layout.row_slots());
}

}  // namespace hopscotch::planner
