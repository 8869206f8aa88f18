#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

namespace {

using model::LinkArray;

LinkArray<double> stance_links(const Eigen::VectorXd& x, int at) {
  return links_from_coordinates(x(at), x(at + 1), x(at + 2), 0.0);
}

LinkArray<double> flight_links(const Eigen::VectorXd& x, int at) {
  return links_from_coordinates(x(at), x(at + 1), x(at + 2), x(at + 3));
}

LinkState takeoff_state(const DecisionLayout& layout, const Eigen::VectorXd& x, int k) {
  const int at = layout.takeoff(k);
  return {stance_links(x, at), stance_links(x, at + kStanceDof)};
}

LinkState flight_state(const DecisionLayout& layout, const Eigen::VectorXd& x, int k) {
  if (k == 0) return takeoff_state(layout, x, layout.steps().takeoff);
  const int at = layout.flight(k);
  return {flight_links(x, at), flight_links(x, at + kFlightDof)};
}

LinkState landing_state(const DecisionLayout& layout, const Eigen::VectorXd& x, int k) {
  if (k == 0 && !layout.steps().landed()) {
    return {stance_links(x, layout.flight(layout.steps().flight)),
            stance_links(x, layout.touchdown_rates())};
  }
  const int at = layout.landing(k);
  return {stance_links(x, at), stance_links(x, at + kStanceDof)};
}

/// Appends the knot at the start of a step from `from` to `to`.
void append(core::JumpPhase phase, double dt, const LinkState& from, const LinkState& to,
            PlanarMotion& motion) {
  PlanarKnot knot;
  knot.phase = phase;
  knot.time = motion.knots.empty() ? 0.0 : motion.knots.back().time + motion.knots.back().dt;
  knot.dt = dt;
  knot.links = from;
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    knot.acceleration[j] = (to.rate[j] - from.rate[j]) / dt;
  }
  motion.knots.push_back(knot);
}

/// All until the feet are down: the flight's parabola, the steps of takeoff and flight.
void append_jump(const PlanarModel& model, const DecisionLayout& layout, const Eigen::VectorXd& x,
                 PlanarMotion& motion) {
  const StepCounts& steps = layout.steps();
  motion.liftoff_com = {x(layout.liftoff_com()), x(layout.liftoff_com() + 1)};
  motion.liftoff_velocity = {x(layout.liftoff_velocity()), x(layout.liftoff_velocity() + 1)};
  motion.momentum = x(layout.momentum());
  for (int k = 0; k < steps.takeoff; ++k) {
    append(core::JumpPhase::takeoff, model.config.takeoff_step(k), takeoff_state(layout, x, k),
           takeoff_state(layout, x, k + 1), motion);
  }
  motion.liftoff_time = motion.knots.back().time + motion.knots.back().dt;
  for (int k = 0; k < steps.flight; ++k) {
    append(core::JumpPhase::flight, x(layout.flight_step()), flight_state(layout, x, k),
           flight_state(layout, x, k + 1), motion);
  }
  motion.touchdown_time = motion.knots.back().time + motion.knots.back().dt;
}

}  // namespace

PlanarMotion motion_from_decision(const PlanarModel& model, const PlanarTask& task,
                                  const DecisionLayout& layout, const Eigen::VectorXd& x) {
  const StepCounts& steps = layout.steps();
  const double sole = model.dynamics.chain().sole_height;
  PlanarMotion motion;
  motion.start_ankle = {model.ankle_x(), sole};
  motion.target_ankle = {task.distance + model.ankle_x(), task.height + sole};
  if (!steps.landed()) append_jump(model, layout, x, motion);
  for (int k = 0; k < steps.landing; ++k) {
    const double step = model.config.landing_share(k) * x(layout.landing_step());
    append(core::JumpPhase::landing, step, landing_state(layout, x, k),
           landing_state(layout, x, k + 1), motion);
  }
  PlanarKnot last;
  last.phase = core::JumpPhase::landing;
  last.time = motion.knots.back().time + motion.knots.back().dt;
  last.links = landing_state(layout, x, steps.landing);
  motion.knots.push_back(last);
  return motion;
}

namespace {

void keep_promise(const PromisedStep& promised, double elapsed, PlanarInstant& now) {
  now.tau = promised.tau;
  now.force = promised.force;
  now.moment = promised.moment;
  now.ankle_velocity = promised.ankle_velocity;
  now.ankle = {promised.ankle.x + elapsed * promised.ankle_velocity.x,
               promised.ankle.z + elapsed * promised.ankle_velocity.z};
}

}  // namespace

PlanarInstant instant(const PlanarModel& model, const PlanarMotion& motion, const PlanarKnot& knot,
                      double elapsed) {
  PlanarInstant now;
  now.phase = knot.phase;
  const double s = knot.dt > 0.0 ? elapsed / knot.dt : 0.0;
  LinkArray<double> acceleration = knot.acceleration;
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    const double u = knot.acceleration[j];
    now.links.pitch[j] = knot.links.pitch[j] + elapsed * (knot.links.rate[j] + 0.5 * elapsed * u) +
                         s * s * (3.0 - 2.0 * s) * knot.correction.turn[j];
    now.links.rate[j] = knot.links.rate[j] + elapsed * u;
    acceleration[j] += knot.correction.acceleration[j];
  }
  const model::PlanarDynamics& dynamics = model.dynamics;
  const LinkState& links = now.links;
  if (knot.phase == core::JumpPhase::flight) {
    const double t = knot.time + elapsed - motion.liftoff_time;
    const model::PlanarVector<double> com = dynamics.com(links.pitch);
    const model::PlanarVector<double> velocity = dynamics.com_velocity(links.pitch, links.rate);
    const model::PlanarVector<double>& v = motion.liftoff_velocity;
    now.ankle = {motion.liftoff_com.x + v.x * t - com.x,
                 motion.liftoff_com.z + v.z * t - 0.5 * model::kGravity * t * t - com.z};
    now.ankle_velocity = {v.x - velocity.x, v.z - model::kGravity * t - velocity.z};
    now.tau = dynamics.flight_torques(links.pitch, links.rate, acceleration);
    if (knot.promised) keep_promise(*knot.promised, elapsed, now);
    return now;
  }
  now.ankle = knot.phase == core::JumpPhase::takeoff ? motion.start_ankle : motion.target_ankle;
  const model::StanceLoads<double> loads =
      dynamics.stance_loads(links.pitch, links.rate, acceleration);
  now.tau = loads.tau;
  now.force = loads.force;
  now.moment = loads.moment;
  if (knot.promised) keep_promise(*knot.promised, elapsed, now);
  return now;
}

}  // namespace hopscotch::planner
