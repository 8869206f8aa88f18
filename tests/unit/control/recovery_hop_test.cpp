#include "control/recovery_hop.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "model/knot_state.hpp"
#include "model/rigid_body.hpp"
#include "model/stand_posture.hpp"
#include "tests/unit/control/hop_config.hpp"

namespace hopscotch::control {
namespace {

constexpr RecoveryHopConfig kConfig = testing::kHopConfig;

/// A robot that stands turned by 0.5 rad somewhere in W.
class RecoveryHopTest : public ::testing::Test {
 protected:
  RecoveryHopTest() {
    const auto pose = model::stand_pose(robot_, {0.39, -0.005, 0.2});
    stand_ = {pose->q, pose->trunk_pitch};
    state_.p_WB = {1.0, -2.0, 0.3 + pose->trunk_height};
    state_.R_WB = model::rotation_from_rpy({0.0, pose->trunk_pitch, kYaw});
    state_.v_WB.setZero();
    state_.w_WB.setZero();
    state_.q = pose->q;
    state_.dq.setZero();
    state_.contact = {true, true};
  }
  /// The same with a speed along and across its heading [m/s].
  core::RobotState moving(double along, double across) const {
    core::RobotState state = state_;
    state.v_WB = in_W(along, across);
    return state;
  }
  static Eigen::Vector3d in_W(double along, double across) {
    return model::rotation_from_rpy({0.0, 0.0, kYaw}) * Eigen::Vector3d(along, across, 0.0);
  }
  Eigen::Vector3d mid_sole(const core::RobotState& state) const {
    const auto soles = model::sole_poses(robot_, state);
    return 0.5 * (soles[0].translation() + soles[1].translation());
  }

  static constexpr double kYaw = 0.5;
  model::RobotParameters robot_ =
      model::RobotParameters::load(HOPSCOTCH_SOURCE_DIR "/config/robots/hector.yaml");
  StandTarget stand_;
  core::RobotState state_;
  core::JumpPlan plan_;
};

TEST_F(RecoveryHopTest, TheCapturePointMovesWithTheSpeedByTheTimeConstantOfThePendulum) {
  const Eigen::Vector2d still = capture_point(robot_, state_);
  EXPECT_NEAR((still - Eigen::Vector2d(-0.005, 0.0)).norm(), 0.0, 1e-3);
  const Eigen::Vector2d moved = capture_point(robot_, moving(0.3, -0.2)) - still;
  const double time = std::sqrt(0.39 / model::kGravity);
  EXPECT_NEAR((moved - time * Eigen::Vector2d(0.3, -0.2)).norm(), 0.0, 1e-3);
}

TEST_F(RecoveryHopTest, HopsOnlyOnceTheCapturePointIsBeyondTheSoles) {
  EXPECT_FALSE(must_hop(kConfig, robot_, state_));
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_FALSE(must_hop(kConfig, robot_, moving(sign * 0.3, 0.0)));
    EXPECT_TRUE(must_hop(kConfig, robot_, moving(sign * 0.5, 0.0)));
    EXPECT_FALSE(must_hop(kConfig, robot_, moving(0.0, sign * 0.4)));
    EXPECT_TRUE(must_hop(kConfig, robot_, moving(0.0, sign * 0.9)));
  }
}

TEST_F(RecoveryHopTest, EveryKnotIsAPostureOfTheRobotWithItsCoMWhereItIsSaidToBe) {
  ASSERT_TRUE(make_recovery_hop(kConfig, robot_, moving(0.5, 0.1), stand_, plan_));
  for (std::size_t i = 0; i < plan_.knot_count; ++i) {
    const core::JumpKnot& knot = plan_.knots[i];
    const core::RobotState posed = model::state_of(knot);
    const model::CompositeBody body = model::composite_body(robot_, posed);
    EXPECT_NEAR((body.p_WG - knot.p_WG).norm(), 0.0, 0.004) << i;
    if (knot.phase != core::JumpPhase::takeoff) continue;
    EXPECT_NEAR((mid_sole(posed) - mid_sole(state_)).norm(), 0.0, 0.004) << i;
  }
}

TEST_F(RecoveryHopTest, TheFlightIsBallisticAndEndsWithTheSolesAtTheCapturePoint) {
  for (const Eigen::Vector2d& speed : {Eigen::Vector2d(0.5, 0.0), Eigen::Vector2d(-0.5, 0.0)}) {
    ASSERT_TRUE(make_recovery_hop(kConfig, robot_, moving(speed.x(), speed.y()), stand_, plan_));
    const auto touchdown = std::find_if(
        plan_.knots.begin(), plan_.knots.end(),
        [](const core::JumpKnot& knot) { return knot.phase == core::JumpPhase::landing; });
    const auto liftoff = std::find_if(
        plan_.knots.begin(), plan_.knots.end(),
        [](const core::JumpKnot& knot) { return knot.phase == core::JumpPhase::flight; });
    const double flight = plan_.touchdown_time - plan_.liftoff_time;
    EXPECT_NEAR(liftoff->v_WG.z(), kConfig.lift_speed, 1e-9);
    const Eigen::Vector3d fallen =
        liftoff->p_WG + flight * liftoff->v_WG -
        Eigen::Vector3d(0.0, 0.0, 0.5 * model::kGravity * flight * flight);
    EXPECT_NEAR((touchdown->p_WG - fallen).norm(), 0.0, 1e-9);
    EXPECT_NEAR(touchdown->p_WG.z() - mid_sole(state_).z(), kConfig.landing_height, 1e-9);
    core::RobotState landed = model::state_of(*touchdown);
    const double time = std::sqrt(kConfig.landing_height / model::kGravity);
    const Eigen::Vector3d capture = touchdown->p_WG + time * touchdown->v_WG;
    EXPECT_NEAR((capture - mid_sole(landed)).head<2>().norm(), 0.0, 0.005);
    EXPECT_GT((mid_sole(landed) - mid_sole(state_)).dot(in_W(speed.x(), speed.y())), 0.05);
  }
}

TEST_F(RecoveryHopTest, ThePlannedForceIsWhatMovesTheBody) {
  ASSERT_TRUE(make_recovery_hop(kConfig, robot_, moving(0.4, 0.0), stand_, plan_));
  for (std::size_t i = 0; i + 1 < plan_.knot_count; ++i) {
    const core::JumpKnot& knot = plan_.knots[i];
    if (knot.phase == core::JumpPhase::landing) continue;
    const Eigen::Vector3d force = knot.wrenches[0].force + knot.wrenches[1].force;
    const Eigen::Vector3d gravity(0.0, 0.0, -model::kGravity);
    const Eigen::Vector3d gain = knot.dt * (force / robot_.total_mass() + gravity);
    EXPECT_NEAR((plan_.knots[i + 1].v_WG - knot.v_WG - gain).norm(), 0.0, 1e-9) << i;
  }
}

TEST_F(RecoveryHopTest, LegsThatAreTooShortMakeNoHop) {
  RecoveryHopConfig giant = kConfig;
  giant.lift_speed = 1.5;
  giant.push_acceleration = 3.0;  // would rise by 0.15 m with the feet on the ground
  core::RobotState state = moving(0.5, 0.0);
  EXPECT_FALSE(make_recovery_hop(giant, robot_, state, stand_, plan_));
}

}  // namespace
}  // namespace hopscotch::control
