#include "planner/flight_phase.hpp"

#include <cmath>
#include <numbers>

namespace hopscotch::planner {

namespace {

template <std::size_t N>
std::array<int, N> following(int first) {
  std::array<int, N> at{};
  for (std::size_t i = 0; i < N; ++i) at[i] = first + static_cast<int>(i);
  return at;
}

void add_momentum(const PlanarModel& model, const DecisionLayout& layout, int knot,
                  BlockList& blocks) {
  std::array<int, 9> at = following<9>(layout.flight(knot));
  at[8] = layout.momentum();
  blocks.push_back(std::make_unique<KnotBlock<MomentumLaw, 9>>(MomentumLaw{model.dynamics}, at));
}

}  // namespace

double clearance_profile(double clearance, double s) {
  const double wave = std::sin(std::numbers::pi * s);
  return clearance * wave * wave;
}

FlightLaw flight_law(const PlanarModel& model, const PlanarTask& task) {
  const PlannerConfig& config = model.config;
  return {model.dynamics,
          {motor_limits(model.robot, config.reserves)},
          StepObjective(config.flight_cost, 1.0 / config.steps.flight, task.final_posture)};
}

LiftoffLaw liftoff_law(const PlanarModel& model) {
  return {model.dynamics, {model.ankle_x(), model.dynamics.chain().sole_height}};
}

ClearanceLaw clearance_law(const PlanarModel& model, const PlanarTask& task, int knot) {
  const double share = static_cast<double>(knot) / model.config.steps.flight;
  return {model.dynamics, task.terrain, static_cast<double>(knot),
          clearance_profile(task.clearance, share), model.config.knee_clearance};
}

std::array<int, 11> liftoff_variables(const DecisionLayout& layout) {
  std::array<int, 11> at{};
  const std::array<int, 6> knot = following<6>(layout.takeoff(layout.steps().takeoff));
  const std::array<int, 5> flight = following<5>(layout.liftoff_com());
  std::copy(flight.begin(), flight.end(), std::copy(knot.begin(), knot.end(), at.begin()));
  return at;
}

std::array<int, 9> clearance_variables(const DecisionLayout& layout, int knot) {
  std::array<int, 9> at = following<9>(layout.flight(knot));
  const std::array<int, 4> com = following<4>(layout.liftoff_com());
  std::copy(com.begin(), com.end(), at.begin() + 4);
  at[8] = layout.flight_step();
  return at;
}

void add_flight(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout,
                BlockList& blocks, StepCorrections corrections) {
  const int steps = layout.steps().flight;
  const FlightLaw law = flight_law(model, task);
  const JointRows<kFlightDof> joints = joint_rows<kFlightDof>(model.robot, model.config);
  using Step = StepBlock<FlightLaw, kFlightDof, StepLength::free>;
  using Knot = KnotBlock<JointRows<kFlightDof>, 2 * kFlightDof>;
  using Clearance = KnotBlock<ClearanceLaw, 9>;
  blocks.push_back(
      std::make_unique<KnotBlock<LiftoffLaw, 11>>(liftoff_law(model), liftoff_variables(layout)));
  for (int k = 0; k < steps; ++k) {
    const StepShift shift = step_shift<kFlightDof>(corrections, layout.steps().takeoff + k);
    blocks.push_back(std::make_unique<Step>(law, layout.flight_step_variables(k), 1.0, shift));
    blocks.push_back(std::make_unique<Knot>(joints, following<8>(layout.flight(k + 1))));
    add_momentum(model, layout, k + 1, blocks);
    if (k + 1 == steps) break;  // touchdown belongs to the landing
    blocks.push_back(std::make_unique<Clearance>(clearance_law(model, task, k + 1),
                                                 clearance_variables(layout, k + 1)));
  }
}

}  // namespace hopscotch::planner
