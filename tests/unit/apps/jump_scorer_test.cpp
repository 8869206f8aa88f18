#include "apps/jump_scorer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "model/kinematics.hpp"

namespace hopscotch::apps {
namespace {

using core::RobotPhase;

/// Takeoff of 0.2 s, flight of 0.1 s at a pitch that grows from -0.8 to -0.4 rad, and a landing
/// that rises to 0.2 rad in another 0.2 s.
core::JumpPlan leaning_plan() {
  core::JumpPlan plan;
  plan.id = 1;
  plan.liftoff_time = 0.2;
  plan.touchdown_time = 0.3;
  plan.duration = 0.5;
  const auto add = [&](double time, double dt, core::JumpPhase phase, double pitch) {
    core::JumpKnot& knot = plan.knots[plan.knot_count++];
    knot.time = time;
    knot.dt = dt;
    knot.phase = phase;
    knot.rpy = {0.0, pitch, 0.0};
  };
  add(0.0, 0.2, core::JumpPhase::takeoff, 0.2);
  add(0.2, 0.1, core::JumpPhase::flight, -0.8);
  add(0.3, 0.2, core::JumpPhase::landing, -0.4);
  add(0.5, 0.0, core::JumpPhase::landing, 0.2);
  return plan;
}

class JumpScored : public ::testing::Test {
 protected:
  /// Goes on for `duration` [s], 1 ms a step.
  void go_on(double duration, RobotPhase phase, bool contact, double beside = 0.0) {
    const auto ticks = static_cast<int>(std::lround(duration / 0.001));
    for (int i = 0; i < ticks; ++i) tick(phase, contact, beside);
  }

  /// @param beside Of the trunk's pitch from the plan's [rad].
  void tick(RobotPhase phase, bool contact, double beside) {
    now_ns_ += 1'000'000;
    const double time = 1e-9 * static_cast<double>(now_ns_ - begin_ns_);
    sim::PlantTruth truth;
    truth.state.stamp = core::Stamp::from_seconds(1e-9 * static_cast<double>(now_ns_));
    truth.state.q.setZero();
    truth.state.dq.setZero();
    truth.state.p_WB = {0.0, 0.0, 0.5};
    truth.state.v_WB = {0.001 * static_cast<double>(now_ns_ / 1'000'000), 0.0, 0.0};
    truth.state.w_WB.setZero();
    truth.state.R_WB = model::rotation_from_rpy({0.0, planned_pitch(time) + beside, 0.0});
    truth.state.contact = {contact, contact};
    for (auto& sole : truth.X_WF) sole = Eigen::Isometry3d::Identity();
    core::ControlStatus status;
    status.phase = phase;
    status.plan_id = plan_.id;
    scorer_.update(truth, truth.state, status, plan_);
  }

  static double planned_pitch(double time) {
    if (time < 0.2) return 0.2 - 5.0 * time;
    if (time < 0.3) return -0.8 + 4.0 * (time - 0.2);
    return -0.4 + 3.0 * (time - 0.3);
  }

  core::JumpPlan plan_ = leaning_plan();
  model::RobotParameters robot_ = model::RobotParameters::load(std::string(HOPSCOTCH_SOURCE_DIR) +
                                                               "/config/robots/hector.yaml");
  JumpScorer scorer_{robot_, sim::Terrain{}};
  std::int64_t begin_ns_ = 0;
  std::int64_t now_ns_ = 0;
};

TEST_F(JumpScored, FlightAndPitchErrorAreThoseBetweenLiftOffAndTouchdown) {
  go_on(0.2, RobotPhase::crouch, true);
  go_on(0.1, RobotPhase::flight, false);
  go_on(0.2, RobotPhase::landing, true, 0.05);
  ASSERT_EQ(scorer_.jumps().size(), 1U);
  EXPECT_NEAR(scorer_.jumps()[0].flight, 0.1, 0.0015);
  EXPECT_NEAR(scorer_.jumps()[0].landing.pitch_error, 0.05, 0.01);
}

TEST_F(JumpScored, SolesThatACrouchUnloadsHaveNotLiftedOff) {
  go_on(0.02, RobotPhase::crouch, true);
  go_on(0.005, RobotPhase::crouch, false);
  go_on(0.155, RobotPhase::crouch, true);
  go_on(0.02, RobotPhase::takeoff, true);
  go_on(0.003, RobotPhase::flight, true);  // by the plan's clock; the ground lets go a little later
  go_on(0.097, RobotPhase::flight, false);
  go_on(0.2, RobotPhase::landing, true, 0.05);
  ASSERT_EQ(scorer_.jumps().size(), 1U);
  const JumpResult& jump = scorer_.jumps()[0];
  EXPECT_NEAR(jump.flight, 0.097, 0.0015);
  EXPECT_NEAR(jump.landing.pitch_error, 0.05, 0.01);
  EXPECT_NEAR(jump.takeoff.speed_x, 0.204, 0.002);  // 0.001 m/s more every tick
}

}  // namespace
}  // namespace hopscotch::apps
