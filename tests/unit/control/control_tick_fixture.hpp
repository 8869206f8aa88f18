#pragma once

#include <gtest/gtest.h>

#include "control/control_tick.hpp"
#include "model/kinematics.hpp"
#include "tests/unit/control/fake_plan.hpp"
#include "tests/unit/control/hop_config.hpp"

namespace hopscotch::control::testing {

inline constexpr double kActuationDelay = 0.002;

inline ControlConfig test_config() {
  ControlConfig config;
  config.gains.kp << 150, 150, 150, 150, 100;
  config.gains.kd << 2, 2, 2, 2, 1;
  config.gains.compliant_scale = 0.4;
  config.gains.fallback_scale = 1.0;
  config.gains.placement_time = 0.2;
  config.gains.placement_dead = 0.08;
  config.gains.placement_max = 0.08;
  config.gains.flight_share = 1.7;
  config.supervisor = {.touchdown_from = 0.5,
                       .flight_overtime = 0.1,
                       .tilt_max = 1.25,
                       .tilt_standing = 0.9,
                       .joint_overshoot = 0.35,
                       .joint_speed_max = 40.0,
                       .joint_speed_standing = 20.0,
                       .fall_time = 0.02,
                       .rest_speed = 0.25,
                       .rest_rate = 1.0,
                       .rest_early = 0.0,
                       .stray_max = 10.0,  // the state does not follow the plan here
                       .commit_speed = 0.2};
  config.recovery_hop = kHopConfig;
  config.recovery_hop.excess_along = 10.0;  // nor does it hop
  config.recovery_hop.excess_across = 10.0;
  config.actuation_delay = kActuationDelay;
  config.mpc_delay = 0.001;
  config.wrench_age_max = 0.025;
  config.anchor_time = 0.15;
  config.settle_time = 0.4;
  config.fixed_step = 0.03;
  config.wrench_mpc.friction = 0.5;
  config.wrench_mpc.cop_toe = 0.06;
  config.wrench_mpc.cop_heel = 0.03;
  config.wrench_mpc.yaw_moment_arm = 0.03;
  config.wrench_mpc.max_normal_force = 500.0;
  return config;
}

/// A robot that stands where it is put, and a jump for it.
class ControlTickFixture : public ::testing::Test {
 protected:
  ControlTickFixture() {
    plan_ = jump_shaped_plan(state_.q);
    for (std::size_t i = 5; i < 10; ++i) plan_.knots[i].v_WG.z() = 1.0;  // pushes off from 0.1 s
  }
  core::JointCommand step(ControlTick& control) {
    core::JointCommand command = control.tick(state_);
    state_.stamp.nanoseconds += 1'000'000;
    return command;
  }
  ControlTick standing() { return {test_config(), robot_, StandTarget{state_.q, 0.0}}; }
  /// Ticks until the phase is there; contact is lost in flight.
  void run_to(ControlTick& control, core::RobotPhase phase) {
    for (int i = 0; i < 1000 && control.phase() != phase; ++i) {
      const bool contact = control.phase() != core::RobotPhase::flight;
      state_.contact = {contact, contact};
      step(control);
    }
    ASSERT_EQ(control.phase(), phase);
    const bool contact = phase != core::RobotPhase::flight;
    state_.contact = {contact, contact};
  }

  /// How the left leg's targets change within a tick of flight in which the trunk turns.
  struct FlightAnswer {
    double hip, ankle;  // [rad]
  };
  FlightAnswer answer_to_turn(double pitch) {
    ControlTick control = standing();
    step(control);
    control.offer(plan_);
    run_to(control, core::RobotPhase::flight);
    const core::JointVector straight = step(control).q;
    state_.R_WB = model::rotation_from_rpy({0.0, pitch, 0.0});
    const core::JointVector change = step(control).q - straight;
    return {change[core::joint_index(core::Leg::left, core::Joint::hip_pitch)],
            change[core::joint_index(core::Leg::left, core::Joint::ankle)]};
  }

  model::RobotParameters robot_ =
      model::RobotParameters::load(HOPSCOTCH_SOURCE_DIR "/config/robots/hector.yaml");
  core::RobotState state_ = standing_robot();
  core::JumpPlan plan_;
};

}  // namespace hopscotch::control::testing
