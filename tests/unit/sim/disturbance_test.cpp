#include "sim/disturbance.hpp"

#include <gtest/gtest.h>

namespace hopscotch::sim {
namespace {

core::JointCommand numbered(double number) {
  core::JointCommand command;
  command.mode = core::DriveMode::active;
  command.tau.setConstant(number);
  return command;
}

TEST(CommandDelay, WhatIsSentInATickActsExactlySoManyTicksLater) {
  for (const int latency : {0, 1, 2, 5}) {
    CommandDelay delay(latency);
    for (std::int64_t tick = 0; tick < 20; ++tick) {
      delay.send(tick, numbered(static_cast<double>(tick)));
      const core::JointCommand acting = delay.in_force(tick);
      if (tick < latency) {
        EXPECT_EQ(acting.mode, core::DriveMode::idle) << latency << " at " << tick;
      } else {
        EXPECT_EQ(acting.tau[0], static_cast<double>(tick - latency)) << latency << " at " << tick;
      }
    }
  }
}

TEST(CommandDelay, TheLastArrivalStaysInForceBetweenExchanges) {
  CommandDelay delay(1);
  delay.send(0, numbered(1.0));
  EXPECT_EQ(delay.in_force(1).tau[0], 1.0);
  EXPECT_EQ(delay.in_force(2).tau[0], 1.0);
  delay.send(2, numbered(2.0));
  EXPECT_EQ(delay.in_force(2).tau[0], 1.0);
  EXPECT_EQ(delay.in_force(3).tau[0], 2.0);
}

Push forward_push() {
  Push push;
  push.impulse = {4.0, 0.0, -1.0};
  push.duration = 0.1;
  return push;
}

Eigen::Vector3d impulse_over(const PushSchedule& schedule, std::int64_t from, std::int64_t to) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::int64_t tick = from; tick < to; ++tick) sum += kTick * schedule.force(tick);
  return sum;
}

TEST(PushSchedule, AnAbsoluteTimeNeedsNoPhase) {
  Push push = forward_push();
  push.at = 0.25;
  const PushSchedule schedule({push});
  EXPECT_TRUE(schedule.force(249).isZero(0.0));
  EXPECT_TRUE(schedule.force(250).isApprox(Eigen::Vector3d(40.0, 0.0, -10.0)));
  EXPECT_TRUE(schedule.force(349).isApprox(Eigen::Vector3d(40.0, 0.0, -10.0)));
  EXPECT_TRUE(schedule.force(350).isZero(0.0));
}

TEST(PushSchedule, ImpulseIsExactEvenIfTheDurationIsNoWholeNumberOfTicks) {
  Push push = forward_push();
  push.duration = 0.0333;
  const PushSchedule schedule({push});
  EXPECT_TRUE(impulse_over(schedule, 0, 1000).isApprox(push.impulse, 1e-12));
}

TEST(PushSchedule, APhasePushWaitsForItsPhase) {
  Push push = forward_push();
  push.phase = core::JumpPhase::takeoff;
  push.after = 0.2;
  PushSchedule schedule({push});
  schedule.notify_phase(0, std::nullopt);
  schedule.notify_phase(100, core::JumpPhase::takeoff);
  for (std::int64_t tick = 101; tick < 150; ++tick) {
    schedule.notify_phase(tick, core::JumpPhase::takeoff);  // told again: no new start
  }
  EXPECT_TRUE(schedule.force(299).isZero(0.0));
  EXPECT_TRUE(schedule.force(300).isApprox(Eigen::Vector3d(40.0, 0.0, -10.0)));
  schedule.notify_phase(310, core::JumpPhase::flight);
  EXPECT_TRUE(impulse_over(schedule, 0, 2000).isApprox(push.impulse, 1e-12));
}

TEST(PushSchedule, APhasePushActsOnlyAtItsOccurrence) {
  Push push = forward_push();
  push.phase = core::JumpPhase::flight;
  push.occurrence = 2;
  PushSchedule schedule({push});
  schedule.notify_phase(10, core::JumpPhase::flight);
  EXPECT_TRUE(schedule.force(10).isZero(0.0));
  schedule.notify_phase(20, core::JumpPhase::landing);
  schedule.notify_phase(500, core::JumpPhase::flight);
  EXPECT_FALSE(schedule.force(500).isZero(0.0));
  schedule.notify_phase(520, core::JumpPhase::landing);
  schedule.notify_phase(900, core::JumpPhase::flight);
  EXPECT_TRUE(impulse_over(schedule, 0, 2000).isApprox(push.impulse, 1e-12));
}

TEST(PushSchedule, OverlappingPushesAdd) {
  Push early = forward_push();
  Push late = forward_push();
  late.at = 0.05;
  const PushSchedule schedule({early, late});
  EXPECT_TRUE(schedule.force(70).isApprox(Eigen::Vector3d(80.0, 0.0, -20.0)));
}

}  // namespace
}  // namespace hopscotch::sim
