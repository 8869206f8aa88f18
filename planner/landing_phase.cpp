#include "planner/landing_phase.hpp"

namespace hopscotch::planner {

ShankRange landed_shank_range(const PlanarModel& model, const PlanarTask& task) {
  const double sole_height = model.dynamics.chain().sole_height;
  return shank_range(model, task.terrain,
                     {task.distance + model.ankle_x(), task.height + sole_height});
}

StanceLaw landing_law(const PlanarModel& model, const PlanarTask& task, int k) {
  const PlannerConfig& config = model.config;
  return {model.dynamics,
          {motor_limits(model.robot, config.reserves)},
          ground_rows(model.dynamics.chain(), config, config.landing_cop_margin),
          StepObjective(config.landing_cost, config.landing_share(k) / config.steps.landing,
                        task.final_posture)};
}

TouchdownLaw touchdown_law(const PlanarModel& model, const PlanarTask& task) {
  const PlannerConfig& config = model.config;
  const model::PlanarVector<double> ankle{task.distance + model.ankle_x(),
                                          task.height + model.dynamics.chain().sole_height};
  return {model.dynamics,
          static_cast<double>(config.steps.flight),
          ankle,
          config.touchdown_speed_down,
          config.touchdown_speed_along,
          config.rate_jump_cost,
          config.touchdown_speed_down_min};
}

std::array<int, 15> touchdown_variables(const DecisionLayout& layout) {
  const int last = layout.flight(layout.steps().flight);
  std::array<int, 15> at{};
  std::size_t next = 0;
  for (int i = 0; i < kStanceDof; ++i) at[next++] = last + i;
  for (int i = 0; i < kFlightDof; ++i) at[next++] = last + kFlightDof + i;
  for (int i = 0; i < kStanceDof; ++i) at[next++] = layout.touchdown_rates() + i;
  for (int i = 0; i < 4; ++i) at[next++] = layout.liftoff_com() + i;
  at[next] = layout.flight_step();
  return at;
}

void add_landing(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout,
                 BlockList& blocks, StepCorrections corrections) {
  const JointRows<kStanceDof> joints = joint_rows<kStanceDof>(model.robot, model.config);
  using Step = StepBlock<StanceLaw, kStanceDof, StepLength::free>;
  using Knot = KnotBlock<JointRows<kStanceDof>, 2 * kStanceDof>;
  const bool landed = layout.steps().landed();
  if (!landed) {
    blocks.push_back(std::make_unique<KnotBlock<TouchdownLaw, 15>>(touchdown_law(model, task),
                                                                   touchdown_variables(layout)));
  }
  for (int k = 0; k < layout.steps().landing; ++k) {
    const std::array<int, 13> ends = layout.landing_step_variables(k);
    const int step = layout.steps().takeoff + layout.steps().flight + k;
    blocks.push_back(std::make_unique<Step>(landing_law(model, task, k), ends,
                                            model.config.landing_share(k),
                                            step_shift<kStanceDof>(corrections, step)));
    if (landed && k == 0) continue;  // the start is as it is
    std::array<int, 6> before{};
    std::copy(ends.begin(), ends.begin() + 6, before.begin());
    blocks.push_back(std::make_unique<Knot>(joints, before));
  }
}

}  // namespace hopscotch::planner
