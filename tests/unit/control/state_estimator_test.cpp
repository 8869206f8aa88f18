#include "control/state_estimator.hpp"

#include <gtest/gtest.h>

#include "control/torque_law.hpp"
#include "core/allocation_count.hpp"
#include "model/gravity.hpp"
#include "model/joint_momentum.hpp"
#include "model/kinematics.hpp"
#include "tests/unit/control/estimator_fixture.hpp"

namespace hopscotch::control {
namespace {

using core::Leg;
using Eigen::Vector3d;

constexpr double kTick = 0.001;

/// Perfect readings of a robot that stands still on both feet, or falls freely without moving a
/// joint.
class StateEstimatorTest : public ::testing::Test {
 protected:
  StateEstimatorTest() {
    truth_.R_WB = model::rotation_from_rpy({0.0, 0.1, 0.4});
    truth_.v_WB.setZero();
    truth_.w_WB.setZero();
    truth_.dq.setZero();
    core::LegVector q;
    q << 0.0, 0.0, 0.8, -1.6, 0.7;  // level soles at a pitch of 0.1
    truth_.q << q, q;
    truth_.p_WB = {2.0, 3.0, 0.5};
    const auto soles = model::sole_poses(robot_, truth_);
    start_ = {0.5 * (soles[0].translation() + soles[1].translation()), 0.4};
  }

  [[nodiscard]] core::SensorReadings standing() const {
    core::SensorReadings readings = falling();
    readings.f_B = truth_.R_WB.transpose() * Vector3d(0.0, 0.0, model::kGravity);
    core::ContactWrenches wrenches{};
    for (core::Wrench& wrench : wrenches) {
      wrench.force.z() = 0.5 * robot_.total_mass() * model::kGravity;
    }
    readings.tau = leg_weight_torques(robot_, truth_) + contact_torques(robot_, truth_, wrenches);
    return readings;
  }
  [[nodiscard]] core::SensorReadings falling() const {
    core::SensorReadings readings;
    readings.q = truth_.q;
    readings.dq.setZero();
    readings.tau.setZero();
    readings.w_WB_B.setZero();
    readings.f_B.setZero();
    return readings;
  }
  void feed(StateEstimator& estimator, core::SensorReadings readings, int ticks,
            ContactExpectation expected) {
    for (int i = 0; i < ticks; ++i) {
      now_ = now_.after(kTick);
      readings.stamp = now_;
      estimator.update(readings, expected);
    }
  }

  model::RobotParameters robot_ =
      model::RobotParameters::load(HOPSCOTCH_SOURCE_DIR "/config/robots/hector.yaml");
  core::RobotState truth_;
  StartPlace start_;
  core::Stamp now_;
};

TEST_F(StateEstimatorTest, StartsAtTheStartPlaceWithLevelSoles) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  feed(estimator, standing(), 1, ContactExpectation::support);
  EXPECT_LT((estimator.state().p_WB - truth_.p_WB).norm(), 1e-9);
  EXPECT_LT((estimator.state().R_WB - truth_.R_WB).norm(), 1e-9);
}

TEST_F(StateEstimatorTest, StandingStillStaysStill) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  feed(estimator, standing(), 500, ContactExpectation::support);
  const core::RobotState& state = estimator.state();
  EXPECT_LT((state.p_WB - truth_.p_WB).norm(), 1e-4);
  EXPECT_LT(state.v_WB.norm(), 1e-4);
  EXPECT_TRUE(state.contact[0] && state.contact[1]);
  const double half_weight = 0.5 * robot_.total_mass() * model::kGravity;
  EXPECT_NEAR(estimator.contacts().force(Leg::left), half_weight, 0.02 * half_weight);
}

TEST_F(StateEstimatorTest, FreeFallIsSeenAndIntegrated) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  feed(estimator, standing(), 300, ContactExpectation::support);
  feed(estimator, falling(), 100, ContactExpectation::airborne);
  const core::RobotState& state = estimator.state();
  EXPECT_FALSE(state.contact[0] || state.contact[1]);
  EXPECT_NEAR(state.v_WB.z(), -model::kGravity * 0.1, 0.02);
  EXPECT_NEAR(truth_.p_WB.z() - state.p_WB.z(), 0.5 * model::kGravity * 0.01, 0.003);
}

TEST_F(StateEstimatorTest, ATouchdownShowsInTheFirstTicks) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  feed(estimator, standing(), 100, ContactExpectation::support);
  feed(estimator, falling(), 100, ContactExpectation::touchdown);
  ASSERT_FALSE(estimator.state().contact[0]);
  feed(estimator, standing(), 4, ContactExpectation::touchdown);
  EXPECT_TRUE(estimator.state().contact[0] && estimator.state().contact[1]);
}

TEST_F(StateEstimatorTest, AFlightWithAWrongAccelerometerIsTakenBackBySolesThatStand) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  feed(estimator, standing(), 300, ContactExpectation::support);
  core::SensorReadings hanging = falling();  // nothing on the soles, and the trunk stays in place
  hanging.f_B = standing().f_B + Vector3d(0.0, 0.0, 1.0);
  feed(estimator, hanging, 250, ContactExpectation::touchdown);
  ASSERT_GT(estimator.state().p_WB.z() - truth_.p_WB.z(), 0.025);
  feed(estimator, standing(), 150, ContactExpectation::touchdown);
  EXPECT_EQ(estimator.counts().flights_doubted, 1U);
  EXPECT_NEAR(estimator.state().p_WB.z(), truth_.p_WB.z(), 0.005);
  EXPECT_NEAR(estimator.state().v_WB.z(), 0.0, 0.01);
}

TEST_F(StateEstimatorTest, AFlightThatFitsTheSolesIsNotDoubted) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  feed(estimator, standing(), 300, ContactExpectation::support);
  core::SensorReadings hanging = falling();
  hanging.f_B = standing().f_B;
  feed(estimator, hanging, 250, ContactExpectation::touchdown);
  ASSERT_FALSE(estimator.state().contact[0]);
  feed(estimator, standing(), 150, ContactExpectation::touchdown);
  EXPECT_EQ(estimator.counts().flights_doubted, 0U);
}

TEST_F(StateEstimatorTest, EarlyInFlightASmallForceIsNoTouchdown) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  feed(estimator, standing(), 100, ContactExpectation::support);
  feed(estimator, falling(), 20, ContactExpectation::airborne);
  feed(estimator, standing(), 50, ContactExpectation::airborne);  // half the weight per foot
  EXPECT_FALSE(estimator.state().contact[0] || estimator.state().contact[1]);
}

TEST_F(StateEstimatorTest, OldReadingsChangeNothing) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  feed(estimator, standing(), 10, ContactExpectation::support);
  core::SensorReadings old = standing();
  old.stamp = now_;
  old.w_WB_B.setConstant(3.0);
  EXPECT_LT(estimator.update(old, ContactExpectation::support).w_WB.norm(), 1e-9);
}

TEST_F(StateEstimatorTest, BadReadingsReachTheSupervisorAndNotTheFilter) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  feed(estimator, standing(), 10, ContactExpectation::support);
  core::SensorReadings bad = standing();
  bad.f_B.x() = core::kNaN;
  feed(estimator, bad, 1, ContactExpectation::support);
  EXPECT_FALSE(estimator.state().w_WB.allFinite());
  EXPECT_EQ(estimator.counts().bad_readings, 1U);
  feed(estimator, standing(), 1, ContactExpectation::support);
  EXPECT_TRUE(estimator.state().w_WB.allFinite());
  EXPECT_LT((estimator.state().p_WB - truth_.p_WB).norm(), 1e-3);
}

TEST_F(StateEstimatorTest, ItAllocatesNothing) {
  StateEstimator estimator(testing::estimator_config(), robot_, start_);
  const std::size_t before = core::allocation_count();
  feed(estimator, standing(), 50, ContactExpectation::support);
  feed(estimator, falling(), 50, ContactExpectation::touchdown);
  feed(estimator, standing(), 50, ContactExpectation::touchdown);
  estimator.correct_height(0.0);
  EXPECT_EQ(core::allocation_count() - before, 0U);
}

}  // namespace
}  // namespace hopscotch::control
