#include "control/wrench_limiter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "control/torque_law.hpp"
#include "control/wrench_mpc_problem.hpp"
#include "core/allocation_count.hpp"
#include "model/kinematics.hpp"
#include "model/motor.hpp"
#include "tests/unit/control/mpc_samples.hpp"

namespace hopscotch::control {
namespace {

class WrenchLimiterTest : public ::testing::Test {
 protected:
  double uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }

  /// Bent knees and feet turned a little, as in a landing.
  core::RobotState landing_state() {
    core::RobotState state;
    state.p_WB = {0.3, -0.2, 0.5};
    state.R_WB = model::rotation_from_rpy({uniform(-0.1, 0.1), uniform(-0.4, 0.4), uniform(-2, 2)});
    state.v_WB.setZero();
    state.w_WB.setZero();
    for (const core::Leg leg : core::kAllLegs) {
      const double knee = uniform(-2.0, -0.6);
      state.q.segment<5>(core::leg_offset(leg)) << uniform(-0.1, 0.1), uniform(-0.1, 0.1),
          -0.5 * knee + uniform(-0.2, 0.2), knee, -0.5 * knee;
      for (int i = 0; i < 5; ++i) state.dq[core::leg_offset(leg) + i] = uniform(-12.0, 12.0);
    }
    return state;
  }

  /// Somewhere in the cone.
  FootInput input_within(double normal_max) {
    const double normal = uniform(0.0, normal_max);
    FootInput u;
    for (int i = 0; i < 4; ++i) u(i) = normal * uniform(-cone_.lower(i), cone_.upper(i));
    u(kForceZ) = normal;
    return u;
  }

  /// Limits the wrenches. @return true if that changed one; the torques are checked to be theirs.
  bool changes(const core::RobotState& state, const core::JointVector& base,
               core::ContactWrenches& wrenches) const {
    const core::ContactWrenches asked = wrenches;
    const core::JointVector tau = limiter_.limit(state, base, wrenches);
    EXPECT_EQ(tau, contact_torques(robot_, state, wrenches));
    return wrenches[0].force != asked[0].force || wrenches[1].force != asked[1].force;
  }

  static double yaw_of(const Eigen::Isometry3d& X_WF) {
    return std::atan2(X_WF.linear()(1, 0), X_WF.linear()(0, 0));
  }

  core::ContactWrenches wrenches_of(const core::RobotState& state,
                                    const std::array<FootInput, 2>& u) const {
    const auto soles = model::sole_poses(robot_, state);
    return {foot_wrench(u[0], yaw_of(soles[0])), foot_wrench(u[1], yaw_of(soles[1]))};
  }
  FootInput input_of(const core::RobotState& state, const core::ContactWrenches& wrenches,
                     core::Leg leg) const {
    const std::size_t i = core::index(leg);
    return foot_input(wrenches[i], yaw_of(model::sole_poses(robot_, state)[i]));
  }

  /// Motor torques of a leg next to `base`.
  core::LegVector motors(const core::RobotState& state, const core::JointVector& base,
                         const core::ContactWrenches& wrenches, core::Leg leg) const {
    const core::JointVector tau = base + contact_torques(robot_, state, wrenches);
    return model::motor_torques(tau.segment<5>(core::leg_offset(leg)));
  }
  /// What is left of the motors' bounds [N·m]; a motor that `base` alone is too much for has none.
  double motor_margin(const core::RobotState& state, const core::JointVector& base,
                      const core::ContactWrenches& wrenches, core::Leg leg) const {
    const core::LegVector torque = motors(state, base, wrenches, leg);
    const core::LegVector alone = motors(state, base, {}, leg);
    const core::LegVector speed = model::motor_speeds(state.dq.segment<5>(core::leg_offset(leg)));
    double margin = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 5; ++i) {
      const auto bounds = model::torque_bounds(robot_, static_cast<core::Joint>(i), speed(i));
      margin = std::min({margin, std::max(bounds.upper, alone(i)) - torque(i),
                         torque(i) - std::min(bounds.lower, alone(i))});
    }
    return margin;
  }
  double cone_margin(const FootInput& u) const {
    double margin = cone_.max_normal_force - u(kForceZ);
    for (int i = 0; i < 4; ++i) {
      margin = std::min(
          {margin, cone_.upper(i) * u(kForceZ) - u(i), cone_.lower(i) * u(kForceZ) + u(i)});
    }
    return margin;
  }

  std::mt19937 random_{11};
  model::RobotParameters robot_ = testing::hector();
  WrenchMpcConfig config_ = WrenchMpcConfig::load(testing::mpc_section());
  WrenchCone cone_ = constant_part(config_, robot_).cone;
  WrenchLimiter limiter_{config_, robot_};
};

TEST_F(WrenchLimiterTest, WhatTheMotorsCanHoldIsLeftToTheBit) {
  int tried = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const core::RobotState state = landing_state();
    const core::JointVector base = leg_weight_torques(robot_, state);
    const core::ContactWrenches asked = wrenches_of(state, {input_within(150), input_within(150)});
    if (motor_margin(state, base, asked, core::Leg::left) < 0.0 ||
        motor_margin(state, base, asked, core::Leg::right) < 0.0) {
      continue;
    }
    ++tried;
    core::ContactWrenches limited = asked;
    EXPECT_EQ(limiter_.limit(state, base, limited), contact_torques(robot_, state, asked));
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      EXPECT_EQ(limited[leg].force, asked[leg].force);
      EXPECT_EQ(limited[leg].moment, asked[leg].moment);
    }
  }
  EXPECT_GT(tried, 50);
}

TEST_F(WrenchLimiterTest, TheRestIsWhatMotorsAndContactCanHold) {
  int replaced = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const core::RobotState state = landing_state();
    core::JointVector base = leg_weight_torques(robot_, state);
    for (int i = 0; i < core::kJoints; ++i) base[i] += uniform(-20.0, 20.0);
    core::ContactWrenches wrenches = wrenches_of(state, {input_within(500), input_within(500)});
    if (!changes(state, base, wrenches)) continue;
    ++replaced;
    for (const core::Leg leg : core::kAllLegs) {
      EXPECT_GE(motor_margin(state, base, wrenches, leg), -1e-3) << trial;
      EXPECT_GE(cone_margin(input_of(state, wrenches, leg)), -1e-3) << trial;
    }
  }
  EXPECT_GT(replaced, 200);
}

/// A projection onto a convex set: from it no feasible point lies in the direction of what was
/// asked.
TEST_F(WrenchLimiterTest, ItIsTheNearestSuchWrench) {
  for (int trial = 0; trial < 100; ++trial) {
    const core::RobotState state = landing_state();
    const core::JointVector base = leg_weight_torques(robot_, state);
    const core::ContactWrenches asked = wrenches_of(state, {input_within(500), input_within(500)});
    core::ContactWrenches nearest = asked;
    if (!changes(state, base, nearest)) continue;
    for (const core::Leg leg : core::kAllLegs) {
      const auto shares = [&](const core::ContactWrenches& wrenches) {
        core::LegVector share = motors(state, base, wrenches, leg);
        for (std::size_t i = 0; i < 5; ++i) {
          share(static_cast<Eigen::Index>(i)) /= robot_.motors[i].torque_max;
        }
        return share;
      };
      const core::LegVector missed = shares(asked) - shares(nearest);
      for (int other = 0; other < 50; ++other) {
        std::array<FootInput, 2> u = {input_within(500), input_within(500)};
        core::ContactWrenches feasible = wrenches_of(state, u);
        while (motor_margin(state, base, feasible, leg) < 0.0) {
          for (FootInput& foot : u) foot *= 0.8;
          feasible = wrenches_of(state, u);
        }
        // Zero but for the ridge that keeps the metric definite.
        EXPECT_LE(missed.dot(shares(feasible) - shares(nearest)), 1e-3 * (1.0 + missed.norm()));
      }
    }
  }
}

TEST_F(WrenchLimiterTest, WithinTheConeItIsWhatTheDrivesWouldClipTo) {
  int compared = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const core::RobotState state = landing_state();
    const core::JointVector base = leg_weight_torques(robot_, state);
    core::ContactWrenches wrenches = wrenches_of(state, {input_within(400), input_within(400)});
    const core::JointVector demand = base + contact_torques(robot_, state, wrenches);
    if (!changes(state, base, wrenches)) continue;
    for (const core::Leg leg : core::kAllLegs) {
      const int first = core::leg_offset(leg);
      const core::LegVector clipped = model::motor_torques(
          model::saturate(robot_, demand.segment<5>(first), state.dq.segment<5>(first)));
      if (cone_margin(input_of(state, wrenches, leg)) < 1.0) continue;
      ++compared;
      EXPECT_LT((motors(state, base, wrenches, leg) - clipped).cwiseAbs().maxCoeff(), 0.02);
    }
  }
  EXPECT_GT(compared, 20);
}

TEST_F(WrenchLimiterTest, AMotorThatIsAskedTooMuchAlreadyGetsNoMore) {
  const core::RobotState state = landing_state();
  core::JointVector base = core::JointVector::Zero();
  base[core::joint_index(core::Leg::left, core::Joint::hip_pitch)] = 100.0;
  const core::LegVector alone = motors(state, base, {}, core::Leg::left);
  for (int trial = 0; trial < 50; ++trial) {
    core::ContactWrenches wrenches = wrenches_of(state, {input_within(300), input_within(300)});
    limiter_.limit(state, base, wrenches);
    constexpr auto kHip = static_cast<Eigen::Index>(core::Joint::hip_pitch);
    EXPECT_LE(motors(state, base, wrenches, core::Leg::left)(kHip), alone(kHip) + 1e-3);
  }
}

TEST_F(WrenchLimiterTest, AllocatesNothing) {
  const core::RobotState state = landing_state();
  const core::JointVector base = leg_weight_torques(robot_, state);
  core::ContactWrenches wrenches =
      wrenches_of(state, {FootInput(100.0, 0.0, -20.0, 0.0, 480.0), input_within(500)});
  const std::size_t before = core::allocation_count();
  EXPECT_TRUE(changes(state, base, wrenches));
  EXPECT_EQ(core::allocation_count(), before);
}

}  // namespace
}  // namespace hopscotch::control
