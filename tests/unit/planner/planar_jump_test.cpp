#include "planner/planar_jump.hpp"

#include <gtest/gtest.h>

#include "tests/unit/planner/solved_jump.hpp"

namespace hopscotch::planner {
namespace {

using model::PlanarVector;
using testing_support::level_jump;
using testing_support::SolvedJump;

/// Rows are solved to 1e-3 at worst, in practice to 1e-5; what follows from them adds up.
constexpr double kSolved = 1e-3;

PlanarVector<double> com(const SolvedJump& jump, const PlanarInstant& now) {
  const PlanarVector<double> from_ankle = jump.model.dynamics.com(now.links.pitch);
  return {now.ankle.x + from_ankle.x, now.ankle.z + from_ankle.z};
}

PlanarVector<double> com_velocity(const SolvedJump& jump, const PlanarInstant& now) {
  const PlanarVector<double> v = jump.model.dynamics.com_velocity(now.links.pitch, now.links.rate);
  return {now.ankle_velocity.x + v.x, now.ankle_velocity.z + v.z};
}

/// Ground impulse less weight over the steps of a phase, and the change of momentum.
void expect_impulse_is_momentum(const SolvedJump& jump, core::JumpPhase phase, double share) {
  const double mass = jump.model.dynamics.chain().total_mass();
  PlanarVector<double> impulse{0.0, 0.0};
  const PlanarKnot* first = nullptr;
  const PlanarKnot* last = nullptr;
  for (const PlanarKnot& knot : jump.motion.knots) {
    if (knot.phase != phase) continue;
    if (first == nullptr) first = &knot;
    if (knot.dt > 0.0) last = &knot;
    const PlanarInstant middle = instant(jump.model, jump.motion, knot, 0.5 * knot.dt);
    impulse.x += knot.dt * middle.force.x;
    impulse.z += knot.dt * (middle.force.z - mass * model::kGravity);
  }
  ASSERT_NE(last, nullptr);
  const PlanarVector<double> before =
      com_velocity(jump, instant(jump.model, jump.motion, *first, 0.0));
  const PlanarVector<double> after =
      com_velocity(jump, instant(jump.model, jump.motion, *last, last->dt));
  const double size = mass * (1.0 + std::hypot(after.x - before.x, after.z - before.z));
  EXPECT_NEAR(impulse.x, mass * (after.x - before.x), share * size);
  EXPECT_NEAR(impulse.z, mass * (after.z - before.z), share * size);
}

TEST(PlanarJump, TakeoffImpulseIsTheMomentumOfLiftoff) {
  expect_impulse_is_momentum(level_jump(), core::JumpPhase::takeoff, 0.005);
}

TEST(PlanarJump, LandingImpulseIsTheMomentumThatItStops) {
  expect_impulse_is_momentum(level_jump(), core::JumpPhase::landing, 0.02);
}

TEST(PlanarJump, LiftoffIsContinuous) {
  const SolvedJump& jump = level_jump();
  const std::size_t first = static_cast<std::size_t>(jump.model.config.steps.takeoff);
  const PlanarKnot& before = jump.motion.knots[first - 1];
  const PlanarInstant end = instant(jump.model, jump.motion, before, before.dt);
  const PlanarInstant begin = instant(jump.model, jump.motion, jump.motion.knots[first], 0.0);
  EXPECT_NEAR(begin.ankle.x, end.ankle.x, kSolved);
  EXPECT_NEAR(begin.ankle.z, end.ankle.z, kSolved);
  EXPECT_NEAR(begin.ankle_velocity.x, 0.0, kSolved);
  EXPECT_NEAR(begin.ankle_velocity.z, 0.0, kSolved);
  EXPECT_NEAR(jump.model.dynamics.centroidal_momentum(begin.links.pitch, begin.links.rate),
              jump.motion.momentum, kSolved);
}

TEST(PlanarJump, FlightKeepsTheAngularMomentum) {
  const SolvedJump& jump = level_jump();
  for (const PlanarKnot& knot : jump.motion.knots) {
    if (knot.phase != core::JumpPhase::flight) continue;
    EXPECT_NEAR(jump.model.dynamics.centroidal_momentum(knot.links.pitch, knot.links.rate),
                jump.motion.momentum, kSolved);
  }
}

TEST(PlanarJump, FootTouchesDownFlatOnTheTarget) {
  const SolvedJump& jump = level_jump();
  const std::size_t touchdown =
      static_cast<std::size_t>(jump.model.config.steps.takeoff + jump.model.config.steps.flight);
  const PlanarKnot& last = jump.motion.knots[touchdown - 1];
  const PlanarInstant end = instant(jump.model, jump.motion, last, last.dt);
  EXPECT_NEAR(end.ankle.x, jump.motion.target_ankle.x, kSolved);
  EXPECT_NEAR(end.ankle.z, jump.motion.target_ankle.z, kSolved);
  EXPECT_NEAR(end.links.pitch[model::kFoot], 0.0, kSolved);
  EXPECT_LE(-end.ankle_velocity.z, jump.model.config.touchdown_speed_down + kSolved);
  const PlanarInstant begin = instant(jump.model, jump.motion, jump.motion.knots[touchdown], 0.0);
  const PlanarVector<double> v0 = com_velocity(jump, end);
  const PlanarVector<double> v1 = com_velocity(jump, begin);
  EXPECT_NEAR(v0.x, v1.x, kSolved);
  EXPECT_NEAR(v0.z, v1.z, kSolved);
  EXPECT_NEAR(end.links.rate[model::kTrunk], begin.links.rate[model::kTrunk], kSolved);
}

TEST(PlanarJump, CentreOfMassFliesAParabola) {
  const SolvedJump& jump = level_jump();
  for (const PlanarKnot& knot : jump.motion.knots) {
    if (knot.phase != core::JumpPhase::flight) continue;
    const double t = knot.time - jump.motion.liftoff_time;
    const PlanarVector<double> now = com(jump, instant(jump.model, jump.motion, knot, 0.0));
    EXPECT_NEAR(now.z,
                jump.motion.liftoff_com.z + jump.motion.liftoff_velocity.z * t -
                    0.5 * model::kGravity * t * t,
                1e-12);
  }
}

TEST(PlanarJump, StepsHaveTheirOwnLengths) {
  const SolvedJump& jump = level_jump();
  double time = 0.0;
  for (const PlanarKnot& knot : jump.motion.knots) {
    EXPECT_NEAR(knot.time, time, 1e-12);
    time += knot.dt;
  }
  EXPECT_EQ(jump.motion.knots.back().dt, 0.0);
}

}  // namespace
}  // namespace hopscotch::planner
