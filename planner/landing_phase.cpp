#include "planner/landing_phase.hpp"

namespace hopscotch::planner {

namespace {

void add_touchdown(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout,
                   BlockList& blocks) {
  const PlannerConfig& config = model.config;
  const model::PlanarVector<double> ankle{task.distance + model.ankle_x(),
                                          task.height + model.dynamics.chain().sole_height};
  const TouchdownLaw law{model.dynamics,
                         static_cast<double>(layout.steps().flight),
                         ankle,
                         config.touchdown_speed_down,
                         config.touchdown_speed_along,
                         config.rate_jump_cost,
                         config.touchdown_speed_down_min};
  const int last = layout.flight(layout.steps().flight);
  std::array<int, 15> at{};
  std::size_t next = 0;
  for (int i = 0; i < kStanceDof; ++i) at[next++] = last + i;
  for (int i = 0; i < kFlightDof; ++i) at[next++] = last + kFlightDof + i;
  for (int i = 0; i < kStanceDof; ++i) at[next++] = layout.touchdown_rates() + i;
  for (int i = 0; i < 4; ++i) at[next++] = layout.liftoff_com() + i;
  at[next] = layout.flight_step();
  blocks.push_back(std::make_unique<KnotBlock<TouchdownLaw, 15>>(law, at));
}

}  // namespace

void add_landing(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout,
                 BlockList& blocks) {
  const PlannerConfig& config = model.config;
  const int steps = layout.steps().landing;
  const MotorRows motors{motor_limits(model.robot, config.reserves)};
  const GroundRows ground = ground_rows(model.dynamics.chain(), config, config.landing_cop_margin);
  const JointRows<kStanceDof> joints = joint_rows<kStanceDof>(model.robot, config);
  using Step = StepBlock<StanceLaw, kStanceDof, StepLength::free>;
  using Knot = KnotBlock<JointRows<kStanceDof>, 2 * kStanceDof>;
  add_touchdown(model, task, layout, blocks);
  for (int k = 0; k < steps; ++k) {
    const std::array<int, 13> ends = layout.landing_step_variables(k);
    const double share = config.landing_share(k);
    const StanceLaw law{model.dynamics, motors, ground,
                        StepObjective(config.landing_cost, share / steps, task.final_posture)};
    blocks.push_back(std::make_unique<Step>(law, ends, share));
    std::array<int, 6> before{};
    std::copy(ends.begin(), ends.begin() + 6, before.begin());
    blocks.push_back(std::make_unique<Knot>(joints, before));
  }
}

}  // namespace hopscotch::planner
