#include "planner/takeoff_phase.hpp"

#include <algorithm>
#include <cmath>

#include "planner/block_forms.hpp"

namespace hopscotch::planner {

namespace {

/// Added to the radius of a standing shank: landings sink deeper than planned [m].
constexpr double kShankRoom = 0.005;

model::PlanarVector<double> knee_at(const PlanarModel& model, double pitch) {
  return model.dynamics.knee(model::LinkArray<double>{0.0, pitch, 0.0, 0.0});
}

/// `shank_room` with the knee at `knee`, seen from the ankle.
double room_around(const SmoothTerrain& terrain, const model::PlanarVector<double>& ankle,
                   const model::PlanarVector<double>& knee, double radius) {
  constexpr int kPoints = 12;  // along the shank: 2 cm apart
  constexpr int kAround = 3;   // to each side of a point
  constexpr int kFirst = 3;    // below it is the foot, which stands
  double room = kUnbounded;
  for (int i = kFirst; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / kPoints;
    const double x = ankle.x + share * knee.x - SmoothTerrain::kEdgeDoubt;
    const double z = ankle.z + share * knee.z;
    // Most points are far above all the ground around them.
    if (z - radius - terrain.height_bound(x - radius, x + radius) >= room) continue;
    for (int j = -kAround; j <= kAround; ++j) {
      const double aside = radius * j / kAround;
      const double lowest = z - std::sqrt(radius * radius - aside * aside);
      room = std::min(room, lowest - terrain.at(x + aside).height);
    }
  }
  return room;
}

}  // namespace

double shank_room(const PlanarModel& model, const SmoothTerrain& terrain,
                  const model::PlanarVector<double>& ankle, double pitch, double radius) {
  return room_around(terrain, ankle, knee_at(model, pitch), radius);
}

ShankRange shank_range(const PlanarModel& model, const SmoothTerrain& terrain,
                       const model::PlanarVector<double>& ankle) {
  constexpr double kStep = 0.005;  // [rad]: 1 mm at the knee
  const double limit = model.config.shank_pitch_max;
  const double radius = model.robot.shank_radius + kShankRoom;
  const auto is_clear = [&](double pitch) {
    const model::PlanarVector<double> knee = knee_at(model, pitch);
    const double ground = terrain.at(ankle.x + knee.x - SmoothTerrain::kEdgeDoubt).height;
    return ankle.z + knee.z >= ground + model.config.knee_clearance &&
           room_around(terrain, ankle, knee, radius) >= 0.0;
  };
  ShankRange range;
  while (range.lower - kStep > -limit && is_clear(range.lower - kStep)) range.lower -= kStep;
  while (range.upper + kStep < limit && is_clear(range.upper + kStep)) range.upper += kStep;
  return range;
}

StanceLaw takeoff_law(const PlanarModel& model, const PlanarTask& task, int k) {
  const PlannerConfig& config = model.config;
  return {model.dynamics,
          {motor_limits(model.robot, config.reserves)},
          ground_rows(model.dynamics.chain(), config, config.takeoff_cop_margin),
          StepObjective(config.takeoff_cost, config.takeoff_step(k) / config.takeoff_time(),
                        task.final_posture)};
}

SmoothnessLaw smoothness_law(const PlannerConfig& config, int k) {
  const int steps = config.steps.takeoff;
  const double mean_step = config.takeoff_time() / steps;
  const double first = config.takeoff_step(k);
  const double second = config.takeoff_step(k + 1);
  // The integral of the squared rate of change of acceleration, for equal steps that of `change`.
  const double weight = config.smoothness_cost / steps * mean_step / (0.5 * (first + second));
  return {weight, first, second};
}

void add_smoothness(const PlanarModel& model, const DecisionLayout& layout, BlockList& blocks) {
  for (int k = 0; k + 2 <= layout.steps().takeoff; ++k) {
    const SmoothnessLaw smoothness = smoothness_law(model.config, k);
    for (int d = 0; d < kStanceDof; ++d) {
      const std::array<int, 3> rates{layout.takeoff(k) + kStanceDof + d,
                                     layout.takeoff(k + 1) + kStanceDof + d,
                                     layout.takeoff(k + 2) + kStanceDof + d};
      blocks.push_back(std::make_unique<KnotBlock<SmoothnessLaw, 3>>(smoothness, rates));
    }
  }
}

void add_takeoff(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout,
                 BlockList& blocks, StepCorrections corrections) {
  const JointRows<kStanceDof> joints = joint_rows<kStanceDof>(model.robot, model.config);
  using Step = StepBlock<StanceLaw, kStanceDof, StepLength::fixed>;
  using Knot = KnotBlock<JointRows<kStanceDof>, 2 * kStanceDof>;
  for (int k = 0; k < layout.steps().takeoff; ++k) {
    const std::array<int, 12> ends = layout.takeoff_step_variables(k);
    blocks.push_back(std::make_unique<Step>(takeoff_law(model, task, k), ends,
                                            model.config.takeoff_step(k),
                                            step_shift<kStanceDof>(corrections, k)));
    std::array<int, 6> after{};
    std::copy(ends.begin() + 6, ends.end(), after.begin());
    blocks.push_back(std::make_unique<Knot>(joints, after));
  }
  add_smoothness(model, layout, blocks);
}

}  // namespace hopscotch::planner
