#include "control/jump_supervisor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
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
                               .tilt_standing = 0.9,
                               .joint_overshoot = 0.35,
                               .joint_speed_max = 40.0,
                               .joint_speed_standing = 20.0,
                               .fall_time = 0.02,
                               .rest_speed = 0.25,
                               .rest_rate = 1.0,
                               .rest_early = 0.02,
                               .commit_speed = 0.2};

class JumpSupervisorTest : public ::testing::Test {
 protected:
  JumpSupervisorTest() {
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
  core::RobotState state_ = testing::standing_robot();
  core::JumpPlan plan_;
};

TEST_F(JumpSupervisorTest, GoesThroughTheTableInOrder) {
  EXPECT_EQ(supervisor_.phase(), RobotPhase::stand);
  supervisor_.begin_jump(plan_);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.001), RobotPhase::crouch);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.199), RobotPhase::takeoff);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.200), RobotPhase::flight);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.260), RobotPhase::landing);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.399), RobotPhase::landing);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.401), RobotPhase::stand);
}

TEST_F(JumpSupervisorTest, ALandingStillInMotionNearItsEndGoesOnAndThenRecovers) {
  fly_to(0.25);
  state_.contact = {true, true};
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.260), RobotPhase::landing);
  state_.v_WB.x() = 0.3;
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.410), RobotPhase::landing);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.421), RobotPhase::recover);
  state_.v_WB.x() = 0.0;
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.422), RobotPhase::stand);
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

TEST_F(JumpSupervisorTest, StandingLimitsAreTighter) {
  state_.R_WB = model::rotation_from_rpy({0.0, 1.0, 0.0});
  supervisor_.begin_jump(plan_);
  EXPECT_EQ(supervisor_.update(state_, plan_, 0.05), RobotPhase::crouch);
  JumpSupervisor standing(kConfig, robot_);
  EXPECT_EQ(standing.update(state_, plan_, 0.05), RobotPhase::fault);
}

TEST_F(JumpSupervisorTest, AStandWithoutGroundIsAFall) {
  state_.contact = {false, false};
  RobotPhase phase = RobotPhase::stand;
  for (int tick = 0; tick <= 20; ++tick) {
    state_.stamp = core::Stamp::from_seconds(0.001 * tick);
    phase = supervisor_.update(state_, plan_, 1.0);
    if (tick < 20) {
      EXPECT_EQ(phase, RobotPhase::stand) << tick;
    }
  }
  EXPECT_EQ(phase, RobotPhase::flight);
}

/// What can happen to the machine besides time.
enum class Event { begin, call_off, hop, hold, release, damp, clear, fault };
constexpr std::array<Event, 8> kEvents{Event::begin,   Event::call_off, Event::hop,   Event::hold,
                                       Event::release, Event::damp,     Event::clear, Event::fault};
constexpr std::array<RobotPhase, 9> kPhases{
    RobotPhase::stand,  RobotPhase::crouch,  RobotPhase::takeoff,
    RobotPhase::flight, RobotPhase::landing, RobotPhase::recover,
    RobotPhase::hold,   RobotPhase::damp,    RobotPhase::fault};

struct Outcome {
  RobotPhase phase;
  bool accepted;
};

/// The table of jump_supervisor.hpp as far as events go, written down a second time.
Outcome expected_outcome(RobotPhase from, Event event) {
  const bool limp = core::is_limp(from);
  switch (event) {
    case Event::begin: {
      const bool starts = from == RobotPhase::stand || from == RobotPhase::landing;
      return {starts ? RobotPhase::crouch : from, true};
    }
    case Event::call_off: {
      const bool can = from == RobotPhase::crouch;
      return {can ? RobotPhase::landing : from, can};
    }
    case Event::hop: {
      const bool can = from == RobotPhase::landing || core::is_standing(from);
      return {can ? RobotPhase::recover : from, can};
    }
    case Event::hold: {
      const bool at_once = core::is_standing(from) || from == RobotPhase::crouch;
      return {at_once ? RobotPhase::hold : from, !limp};
    }
    case Event::release:
      if (from == RobotPhase::hold || from == RobotPhase::damp) return {RobotPhase::stand, true};
      return {from, !limp};
    case Event::damp:
      if (from == RobotPhase::fault) return {from, false};
      return {RobotPhase::damp, true};
    case Event::clear:
      if (from == RobotPhase::fault) return {RobotPhase::damp, true};
      return {from, false};
    case Event::fault: return {RobotPhase::fault, true};
  }
  return {from, false};
}

class EveryPhase : public JumpSupervisorTest {
 protected:
  /// A machine that has come to `phase` by the way of the table.
  JumpSupervisor at(RobotPhase phase) {
    JumpSupervisor machine(kConfig, robot_);
    core::RobotState state = state_;
    if (phase == RobotPhase::hold) {
      EXPECT_TRUE(machine.hold());
    }
    if (phase == RobotPhase::damp) {
      EXPECT_TRUE(machine.damp());
    }
    if (phase == RobotPhase::fault) machine.latch(Reason::stale_sensors);
    const std::vector<std::pair<RobotPhase, double>> way{{RobotPhase::crouch, 0.01},
                                                         {RobotPhase::takeoff, 0.15},
                                                         {RobotPhase::flight, 0.21},
                                                         {RobotPhase::landing, 0.3},
                                                         {RobotPhase::recover, 0.43}};
    const bool jumps =
        std::any_of(way.begin(), way.end(), [&](const auto& step) { return step.first == phase; });
    if (jumps) machine.begin_jump(plan_);
    for (const auto& [name, time] : way) {
      if (machine.phase() == phase) break;
      if (name == RobotPhase::recover) state.v_WB.x() = 1.0;
      machine.update(state, plan_, time);
    }
    EXPECT_EQ(machine.phase(), phase);
    return machine;
  }

  bool cause(JumpSupervisor& machine, Event event) {
    switch (event) {
      case Event::begin: machine.begin_jump(plan_); return true;
      case Event::call_off: return machine.call_off();
      case Event::hop: return machine.hop();
      case Event::hold: return machine.hold();
      case Event::release: return machine.release(state_);
      case Event::damp: return machine.damp();
      case Event::clear: return machine.clear_fault();
      case Event::fault: machine.latch(Reason::deadline); return true;
    }
    return false;
  }
};

TEST_F(EveryPhase, AnswersEachEventAsTheTableSays) {
  for (const RobotPhase phase : kPhases) {
    for (const Event event : kEvents) {
      JumpSupervisor machine = at(phase);
      const bool accepted = cause(machine, event);
      const Outcome expected = expected_outcome(phase, event);
      EXPECT_EQ(machine.phase(), expected.phase)
          << core::robot_phase_name(phase) << ", event " << static_cast<int>(event);
      EXPECT_EQ(accepted, expected.accepted)
          << core::robot_phase_name(phase) << ", event " << static_cast<int>(event);
    }
  }
}

TEST_F(EveryPhase, AHoldThatWaitedHoldsAfterTheLanding) {
  for (const RobotPhase phase : {RobotPhase::takeoff, RobotPhase::flight, RobotPhase::landing}) {
    JumpSupervisor machine = at(phase);
    EXPECT_TRUE(machine.hold());
    machine.update(state_, plan_, 0.25);
    machine.update(state_, plan_, 0.30);
    machine.update(state_, plan_, 0.43);
    EXPECT_EQ(machine.phase(), RobotPhase::hold) << core::robot_phase_name(phase);
  }
}

TEST_F(EveryPhase, ABadNumberIsAFaultButWhereTheRobotIsLimp) {
  core::RobotState bad = state_;
  bad.dq[4] = core::kNaN;
  for (const RobotPhase phase : kPhases) {
    JumpSupervisor machine = at(phase);
    machine.update(bad, plan_, 0.1);
    EXPECT_EQ(machine.phase(), phase == RobotPhase::damp ? RobotPhase::damp : RobotPhase::fault);
  }
}

TEST_F(EveryPhase, ALimpRobotStaysDownWhenItCannotStand) {
  JumpSupervisor machine = at(RobotPhase::damp);
  core::RobotState lying = state_;
  lying.R_WB = model::rotation_from_rpy({1.4, 0.0, 0.0});
  EXPECT_FALSE(machine.release(lying));
  EXPECT_EQ(machine.phase(), RobotPhase::damp);
}

TEST_F(EveryPhase, ARecoveryHopLeavesTheGroundByItsClockAndEndsWithTheTouchdown) {
  for (const RobotPhase phase : {RobotPhase::stand, RobotPhase::landing, RobotPhase::hold}) {
    JumpSupervisor machine = at(phase);
    ASSERT_TRUE(machine.hop());
    EXPECT_TRUE(machine.is_hopping());
    EXPECT_EQ(machine.update(state_, plan_, 0.199), RobotPhase::recover);  // though at rest
    core::RobotState flying = state_;
    flying.contact = {false, false};
    EXPECT_EQ(machine.update(flying, plan_, 0.200), RobotPhase::flight);
    EXPECT_TRUE(machine.is_hopping());
    EXPECT_EQ(machine.update(state_, plan_, 0.260), RobotPhase::landing);
    EXPECT_FALSE(machine.is_hopping());
    const bool held = phase == RobotPhase::hold;
    EXPECT_EQ(machine.update(state_, plan_, 0.420), held ? RobotPhase::hold : RobotPhase::stand);
  }
}

TEST_F(EveryPhase, AHoldDuringARecoveryHopWaitsForItsLanding) {
  JumpSupervisor machine = at(RobotPhase::recover);
  ASSERT_TRUE(machine.hop());
  EXPECT_TRUE(machine.hold());
  EXPECT_EQ(machine.update(state_, plan_, 0.1), RobotPhase::recover);
  core::RobotState flying = state_;
  flying.contact = {false, false};
  EXPECT_EQ(machine.update(flying, plan_, 0.200), RobotPhase::flight);
  EXPECT_EQ(machine.update(state_, plan_, 0.260), RobotPhase::landing);
  EXPECT_EQ(machine.update(state_, plan_, 0.420), RobotPhase::hold);
}

TEST_F(JumpSupervisorTest, TheCommitPointIsWhereTheBodyBeginsToRise) {
  EXPECT_DOUBLE_EQ(commit_time(plan_, 0.2), plan_.knots[4].time);  // it rises from knot 5 on
  EXPECT_DOUBLE_EQ(commit_time(plan_, 2.0), plan_.knots[9].time);
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
