#include "planner/shared_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/motor.hpp"
#include "planner/block_forms.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::hector;
using testing_support::shipped_config;

constexpr Reserves kAll{1.0, 1.0, 1.0, 1.0};

/// Torque, line at both ends and power rows of the knee motor alone, over a step of no change.
std::array<double, 4> knee_rows(const MotorRows& rows, double torque, double speed) {
  std::array<double, MotorRows::kRows> out{};
  // Knee motor torque is tau_knee - tau_ankle; shank rate minus thigh rate is the knee's.
  rows.write(model::PlanarJoints<double>{0.0, torque, 0.0},
             model::LinkArray<double>{0.0, speed, 0.0, 0.0}, model::LinkArray<double>{},
             out.data());
  return {out[4], out[5], out[6], out[7]};
}

bool within(const MotorRows& rows, const std::array<double, 4>& knee) {
  std::array<double, MotorRows::kRows> lower{};
  std::array<double, MotorRows::kRows> upper{};
  rows.bounds(lower, upper);
  for (std::size_t i = 0; i < knee.size(); ++i) {
    if (knee[i] < lower[4 + i] - 1e-12 || knee[i] > upper[4 + i] + 1e-12) return false;
  }
  return true;
}

TEST(MotorRows, AllowWhatTheMotorEnvelopeAllows) {
  const model::RobotParameters robot = hector();
  const MotorRows rows{motor_limits(robot, kAll)};
  const double speed_max = robot.motors[core::index(core::Joint::knee)].speed_max;
  constexpr double kInside = 0.999;
  constexpr double kOutside = 1.001;
  for (double speed = 0.0; speed < 0.95 * speed_max; speed += 0.5) {
    const double upper = model::torque_bounds(robot, core::Joint::knee, speed).upper;
    EXPECT_TRUE(within(rows, knee_rows(rows, 2.0 * kInside * upper, speed))) << speed;
    EXPECT_FALSE(within(rows, knee_rows(rows, 2.0 * kOutside * upper, speed))) << speed;
    EXPECT_TRUE(within(rows, knee_rows(rows, -2.0 * kInside * upper, -speed))) << speed;
    EXPECT_FALSE(within(rows, knee_rows(rows, -2.0 * kOutside * upper, -speed))) << speed;
  }
}

TEST(MotorRows, KeepThePowerRowWhereTheLineAllowsMorePower) {
  const std::filesystem::path file =
      testing_support::config_folder() / "robots" / "hector-sim.yaml";
  const MotorRows fast{motor_limits(model::RobotParameters::load(file), kAll)};
  const MotorRows slow{motor_limits(hector(), kAll)};
  std::array<double, MotorRows::kRows> lower{};
  std::array<double, MotorRows::kRows> upper{};
  fast.bounds(lower, upper);
  EXPECT_EQ(upper[7], 1.0);
  slow.bounds(lower, upper);
  EXPECT_EQ(upper[7], kUnbounded);
}

TEST(MotorRows, CheckTheLineAtBothEndsOfAStep) {
  const MotorRows rows{motor_limits(hector(), kAll)};
  std::array<double, MotorRows::kRows> out{};
  rows.write(model::PlanarJoints<double>{0.0, 10.0, 0.0},
             model::LinkArray<double>{0.0, 5.0, 0.0, 0.0},
             model::LinkArray<double>{0.0, 1.0, 0.0, 0.0}, out.data());
  EXPECT_NEAR(out[5], knee_rows(rows, 10.0, 4.0)[1], 1e-12);
  EXPECT_NEAR(out[6], knee_rows(rows, 10.0, 6.0)[1], 1e-12);
}

TEST(GroundRows, VanishWhereTheCentreOfPressureReachesAnEdge) {
  const model::PlanarChain chain = model::lump_legs(hector());
  const GroundRows rows = ground_rows(chain, shipped_config(), 0.015);
  constexpr double kForce = 200.0;  // [N]
  constexpr double kAlong = 30.0;   // [N]
  const auto evaluate = [&](double pressure) {
    model::StanceLoads<double> loads;
    loads.force = {kAlong, kForce};
    loads.moment = -chain.sole_height * kAlong - pressure * kForce;
    std::array<double, GroundRows::kRows> out{};
    rows.write(loads, out.data());
    return out;
  };
  EXPECT_NEAR(evaluate(chain.toe - 0.015)[3], 0.0, 1e-12);
  EXPECT_NEAR(evaluate(-(chain.heel - 0.015))[4], 0.0, 1e-12);
  EXPECT_LT(evaluate(chain.toe)[3], 0.0);
  EXPECT_LT(evaluate(-chain.heel)[4], 0.0);
}

TEST(GroundRows, BoundFrictionOnBothSides) {
  const PlannerConfig config = shipped_config();
  const GroundRows rows = ground_rows(model::lump_legs(hector()), config, 0.0);
  const double friction = config.friction * config.reserves.friction;
  for (const double sign : {-1.0, 1.0}) {
    model::StanceLoads<double> loads;
    loads.force = {sign * friction * 100.0, 100.0};
    loads.moment = 0.0;
    std::array<double, GroundRows::kRows> out{};
    rows.write(loads, out.data());
    EXPECT_NEAR(std::min(out[1], out[2]), 0.0, 1e-12);
    EXPECT_GT(std::max(out[1], out[2]), 0.0);
  }
}

TEST(JointRows, HaveExactDerivativesAndNoCurvature) {
  const KnotBlock<JointRows<kFlightDof>, 8> block(
      joint_rows<kFlightDof>(hector(), shipped_config()), {0, 1, 2, 3, 4, 5, 6, 7});
  const testing_support::DerivativeError error =
      testing_support::derivative_error(block, testing_support::random_point(8, 4));
  EXPECT_LT(error.slopes, testing_support::kDerivativeTolerance);
  EXPECT_LT(error.curvature, testing_support::kDerivativeTolerance);
}

}  // namespace
}  // namespace hopscotch::planner
