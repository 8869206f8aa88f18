#include "control/jump_supervisor.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "model/kinematics.hpp"
#include "tests/unit/control/fake_plan.hpp"

namespace hopscotch::control {
namespace {

using core::Reason;
using core::RobotPhase;

const SupervisorConfig kConfig{.touchdown_from = 0.5,
                               .flight_overtime = 0.1,
                               .tilt_max = 1.25,
                               .joint_overshoot = 0.35,
                               .joint_speed_max = 40.0,
                               .rest_speed = 0.25,
                               .rest_rate = 1.0,
                               .commit_speed = 0.2};

class JumpSupervisorTest : public ::testing::Test {
 protected:
  JumpSupervisorTest() {
    state_.p_WB = {0.0, 0.0, 0.55};
    state_.R_WB.setIdentity();
    state_.v_WB.setZero();
    state_.w_WB.setZero();
    state_.q << 0, 0, 0.785, -1.571, 0.785, 0, 0, 0.785, -1.571, 0.785;
    state_.dq.setZero();
    state_.contact = {true, true};
    plan_ = testing::jump_shaped_plan(state_.q);
    for (std::size_t i = 5; i < 10; ++i) plan_.knots[i].v_WG.z() = 1.0;  // pushes off from 0.1 s
  }
  /// The phase reached after a jump has begun and `plan_time` has come, without contact in flight.
  void fly_to(double plan_time) {
    supervisor_.begin_jump(plan_);
    for (double t = 0.0; t < plan_time; t += 0.001) {
      state_.contact = {t < 0.2, t < 0.2};
      supervisor_.update(state_, plan_, t);
    }
  }

  model::RobotParameters robot_ =
      model::RobotParameters::load(HOPSCOTCH_SOURCE_DIR "/config/robots/hector.yaml");
  JumpSupervisor supervisor_{kConfig, robot_};
  core::RobotState state_;
  core::JumpPlan plan_;
};

TEST_F(JumpSupervisorTest, GoesThroughTheTableInOrder) {
  EXPECT_EQ(supervisor_.phase(), RobotPhase::stand);
  supervisor_.begin_jump(plan_);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.001), RobotPhase::crouch);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.199), RobotPhase::takeoff);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.200), RobotPhase::flight);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.260), RobotPhase::landing);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.419), RobotPhase::landing);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.420), RobotPhase::stand);
}

TEST_F(JumpSupervisorTest, ContactEarlyInFlightIsTheLiftOffAndNoTouchdown) {
  supervisor_.begin_jump(plan_);
  supervisor_.update(state_, plan_, 0.2);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.24), RobotPhase::flight);
}

TEST_F(JumpSupervisorTest, LateTouchdownIsWaitedForAndThenAFault) {
  fly_to(0.39);
  EXPECT_EQ(supervisor_.phase(), RobotPhase::flight);
  fly_to(0.41);
  EXPECT_EQ(supervisor_.phase(), RobotPhase::fault);
  EXPECT_EQ(supervisor_.fault(), Reason::no_touchdown);
}

TEST_F(JumpSupervisorTest, AJumpBeginsOnlyFromStandOrLanding) {
  fly_to(0.25);
  ASSERT_EQ(supervisor_.phase(), RobotPhase::flight);
  supervisor_.begin_jump(plan_);
  EXPECT_EQ(supervisor_.phase(), RobotPhase::flight);
}

TEST_F(JumpSupervisorTest, EachLimitIsAFaultInEachPhase) {
  const std::vector<double> times{-1.0, 0.1, 0.25};  // stand, takeoff, flight
  for (const double time : times) {
    const auto fault_of = [&](auto&& spoil) {
      JumpSupervisor supervisor(kConfig, robot_);
      if (time >= 0.0) supervisor.begin_jump(plan_);
      for (double t = 0.0; t <= time; t += 0.001) {
        core::RobotState flying = state_;
        if (t >= 0.2) flying.contact = {false, false};
        supervisor.update(flying, plan_, t);
      }
      core::RobotState bad = state_;
      bad.contact = {false, false};
      spoil(bad);
      EXPECT_EQ(supervisor.update(bad, plan_, time), RobotPhase::fault);
      return supervisor.fault();
    };
    EXPECT_EQ(fault_of([](core::RobotState& s) { s.q[3] = core::kNaN; }), Reason::bad_sensor_value);
    EXPECT_EQ(fault_of([](core::RobotState& s) {
                s.R_WB = model::rotation_from_rpy({0.0, 1.3, 0.0});
              }),
              Reason::tilt_limit);
    EXPECT_EQ(fault_of([](core::RobotState& s) { s.q[3] = 0.5; }), Reason::joint_limit);
    EXPECT_EQ(fault_of([](core::RobotState& s) { s.dq[0] = -50.0; }), Reason::joint_limit);
  }
}

TEST_F(JumpSupervisorTest, TheFirstFaultIsLatched) {
  supervisor_.latch(Reason::stale_sensors);
  state_.q[0] = core::kNaN;
  supervisor_.update(state_, plan_, 0.0);
  EXPECT_EQ(supervisor_.fault(), Reason::stale_sensors);
  supervisor_.begin_jump(plan_);
  EXPECT_EQ(supervisor_.phase(), RobotPhase::fault);
}

}  // namespace
}  // namespace hopscotch::control
