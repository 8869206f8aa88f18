#include "planner/motion_sampler.hpp"

#include <algorithm>

#include "planner/warm_start.hpp"

namespace hopscotch::planner {

MotionSampler::MotionSampler(const PlanarModel& model, const PlanarTask& task) : model_(model) {
  const DecisionLayout layout(model.config.steps);
  motion_ = motion_from_decision(model, task, layout, kinematic_guess(model, task, layout));
}

double MotionSampler::begin(core::JumpPhase phase) const {
  if (phase == core::JumpPhase::takeoff) return 0.0;
  return phase == core::JumpPhase::flight ? motion_.liftoff_time : motion_.touchdown_time;
}

double MotionSampler::duration(core::JumpPhase phase) const {
  if (phase == core::JumpPhase::takeoff) return motion_.liftoff_time;
  if (phase == core::JumpPhase::flight) return motion_.touchdown_time - motion_.liftoff_time;
  return motion_.knots.back().time - motion_.touchdown_time;
}

PlanarInstant MotionSampler::at(core::JumpPhase phase, double share) const {
  const double time = begin(phase) + share * duration(phase);
  const PlanarKnot* found = &motion_.knots.front();
  for (const PlanarKnot& knot : motion_.knots) {
    if (knot.phase == phase && (found->phase != phase || knot.time <= time)) found = &knot;
  }
  return instant(model_, motion_, *found, std::max(0.0, time - found->time));
}

void add_rates_by_differences(PlanarMotion& motion) {
  for (std::size_t i = 1; i + 1 < motion.knots.size(); ++i) {
    PlanarKnot& knot = motion.knots[i];
    const PlanarKnot& before = motion.knots[i - 1];
    // At lift-off the stance counts, not what the legs do next.
    const bool liftoff = before.phase != knot.phase && knot.phase == core::JumpPhase::flight;
    const PlanarKnot& after = liftoff ? knot : motion.knots[i + 1];
    const double span = before.dt + (liftoff ? 0.0 : knot.dt);
    for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
      knot.links.rate[j] = (after.links.pitch[j] - before.links.pitch[j]) / span;
    }
    if (knot.phase != core::JumpPhase::flight) continue;
    knot.promised->ankle_velocity = {(after.promised->ankle.x - before.promised->ankle.x) / span,
                                     (after.promised->ankle.z - before.promised->ankle.z) / span};
  }
}

void complete_motion(const PlanarModel& model, const PlanarTask& task, PlanarMotion& motion) {
  const double sole = model.dynamics.chain().sole_height;
  motion.start_ankle = {model.ankle_x(), sole};
  motion.target_ankle = {task.distance + model.ankle_x(), task.height + sole};
  double time = 0.0;
  for (std::size_t i = 0; i < motion.knots.size(); ++i) {
    PlanarKnot& knot = motion.knots[i];
    knot.time = time;
    time += knot.dt;
    if (i + 1 == motion.knots.size()) break;
    const PlanarKnot& next = motion.knots[i + 1];
    for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
      knot.acceleration[j] = (next.links.rate[j] - knot.links.rate[j]) / knot.dt;
    }
    if (next.phase == core::JumpPhase::flight && knot.phase == core::JumpPhase::takeoff) {
      const model::PlanarVector<double> com = model.dynamics.com(next.links.pitch);
      motion.liftoff_time = time;
      motion.liftoff_com = {motion.start_ankle.x + com.x, motion.start_ankle.z + com.z};
      motion.liftoff_velocity = model.dynamics.com_velocity(next.links.pitch, next.links.rate);
      motion.momentum = model.dynamics.centroidal_momentum(next.links.pitch, next.links.rate);
    }
    if (next.phase == core::JumpPhase::landing && knot.phase == core::JumpPhase::flight) {
      motion.touchdown_time = time;
    }
  }
}

}  // namespace hopscotch::planner
