#include "planner/decision_bounds.hpp"

#include <algorithm>

#include "planner/landing_phase.hpp"
#include "planner/shared_limits.hpp"

namespace hopscotch::planner {

namespace {

/// Absolute rates have no physical limit of their own; this only keeps the search sane.
constexpr double kRateMax = 40.0;      // [rad/s]
constexpr double kTypicalRate = 5.0;   // [rad/s]
constexpr double kTypicalStep = 0.02;  // [s]
/// Further back than at the start a shank may lean in any case [rad]: 1 cm at the knee.
constexpr double kStartRoom = 0.05;

struct Writer {
  DecisionBounds bounds;

  void set(int at, double lower, double upper) {
    bounds.lower(at) = lower;
    bounds.upper(at) = upper;
  }
  void fix(int at, double value) { set(at, value, value); }
};

void bound_knot(const PlanarModel& model, const ShankRange& shank, int y, int v, Writer& writer) {
  const PlannerConfig& config = model.config;
  const model::JointRange knee =
      model::joint_range(model.robot, core::Leg::left, core::Joint::knee);
  const double knee_speed = motor_limits(model.robot, config.reserves).knee.speed;
  writer.set(y + kShankPitch, shank.lower, shank.upper);
  writer.set(y + kKneeAngle, knee.lower + config.joint_margin, knee.upper - config.joint_margin);
  writer.set(y + kTrunkPitch, config.trunk_pitch_min, config.trunk_pitch_max);
  writer.set(v + kShankPitch, -kRateMax, kRateMax);
  writer.set(v + kKneeAngle, -knee_speed, knee_speed);
  writer.set(v + kTrunkPitch, -kRateMax, kRateMax);
}

void fix_knot(const LinkState& state, int at, Writer& writer) {
  const std::array<double, kFlightDof> y = coordinates_from_links(state.pitch);
  const std::array<double, kFlightDof> v = coordinates_from_links(state.rate);
  for (int d = 0; d < kStanceDof; ++d) {
    writer.fix(at + d, y[static_cast<std::size_t>(d)]);
    writer.fix(at + kStanceDof + d, v[static_cast<std::size_t>(d)]);
  }
}

void bound_landing(const PlanarModel& model, const PlanarTask& task, const ShankRange& target,
                   const DecisionLayout& layout, Writer& writer) {
  for (int k = 1; k < layout.steps().landing; ++k) {
    bound_knot(model, target, layout.landing(k), layout.landing(k) + kStanceDof, writer);
  }
  fix_knot({task.final_posture, {}}, layout.landing(layout.steps().landing), writer);
  writer.set(layout.landing_step(), model.config.landing_step_min,
             model.config.landing_step_longest(task.distance, task.height));
}

void bound_flight(const PlanarModel& model, const ShankRange& landing_shank,
                  const DecisionLayout& layout, Writer& writer) {
  const PlannerConfig& config = model.config;
  const ShankRange free{-config.shank_pitch_max, config.shank_pitch_max};
  const int last = layout.steps().flight;
  for (int k = 1; k <= last; ++k) {
    const int y = layout.flight(k);
    const int v = y + kFlightDof;
    bound_knot(model, k == last ? landing_shank : free, y, v, writer);
    writer.set(y + kFootPitch, -config.foot_pitch_max, config.foot_pitch_max);
    writer.set(v + kFootPitch, -kRateMax, kRateMax);
  }
  writer.fix(layout.flight(last) + kFootPitch, 0.0);
  writer.set(layout.flight(last) + kFlightDof + kFootPitch, -config.touchdown_foot_rate,
             config.touchdown_foot_rate);
  for (int i = 0; i < 5; ++i) writer.set(layout.liftoff_com() + i, -kUnbounded, kUnbounded);
  writer.set(layout.flight_step(), config.flight_step_min, config.flight_step_max);
}

}  // namespace

DecisionBounds decision_bounds(const PlanarModel& model, const PlanarTask& task,
                               const DecisionLayout& layout) {
  Writer writer;
  writer.bounds.lower = Eigen::VectorXd::Zero(layout.size());
  writer.bounds.upper = Eigen::VectorXd::Zero(layout.size());
  const ShankRange target = landed_shank_range(model, task);
  bound_landing(model, task, target, layout, writer);
  if (layout.steps().landed()) {
    fix_knot(task.start, layout.landing(0), writer);
    return writer.bounds;
  }
  const double sole_height = model.dynamics.chain().sole_height;
  ShankRange start = shank_range(model, task.terrain, {model.ankle_x(), sole_height});
  // Where the robot stands its shanks touch nothing, whatever the map says.
  start.lower = std::min(start.lower, task.start.pitch[model::kShank] - kStartRoom);
  for (int k = 1; k <= layout.steps().takeoff; ++k) {
    bound_knot(model, start, layout.takeoff(k), layout.takeoff(k) + kStanceDof, writer);
  }
  bound_flight(model, target, layout, writer);
  bound_knot(model, target, layout.flight(layout.steps().flight), layout.touchdown_rates(), writer);
  fix_knot(task.start, layout.takeoff(0), writer);
  return writer.bounds;
}

Eigen::VectorXd decision_sizes(const DecisionLayout& layout) {
  Eigen::VectorXd size = Eigen::VectorXd::Ones(layout.size());
  for (int k = 1; k <= layout.steps().landing; ++k) {
    size.segment(layout.landing(k) + kStanceDof, kStanceDof).setConstant(kTypicalRate);
  }
  size(layout.landing_step()) = kTypicalStep;
  if (layout.steps().landed()) return size;
  for (int k = 0; k <= layout.steps().takeoff; ++k) {
    size.segment(layout.takeoff(k) + kStanceDof, kStanceDof).setConstant(kTypicalRate);
  }
  for (int k = 1; k <= layout.steps().flight; ++k) {
    size.segment(layout.flight(k) + kFlightDof, kFlightDof).setConstant(kTypicalRate);
  }
  size.segment(layout.touchdown_rates(), kStanceDof).setConstant(kTypicalRate);
  size(layout.flight_step()) = kTypicalStep;
  return size;
}

}  // namespace hopscotch::planner
