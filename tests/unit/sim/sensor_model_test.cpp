#include "sim/sensor_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hopscotch::sim {
namespace {

core::SensorReadings at_rest() {
  core::SensorReadings truth;
  truth.q.setConstant(0.3);
  truth.dq.setZero();
  truth.tau.setConstant(5.0);
  truth.w_WB_B.setZero();
  truth.f_B = {0.0, 0.0, 9.81};
  return truth;
}

TEST(SensorModel, AtScaleZeroItIsPerfect) {
  SensorModel sensors(3, 0.0);
  const core::SensorReadings truth = at_rest();
  const core::SensorReadings reading = sensors.measure(truth);
  EXPECT_EQ(reading.q, truth.q);
  EXPECT_EQ(reading.dq, truth.dq);
  EXPECT_EQ(reading.tau, truth.tau);
  EXPECT_EQ(reading.w_WB_B, truth.w_WB_B);
  EXPECT_EQ(reading.f_B, truth.f_B);
}

TEST(SensorModel, NoiseHasTheStatedSpread) {
  constexpr int kSamples = 4000;  // of 10 joints: the spread is known to 0.4 %
  constexpr double kTolerance = 0.03;
  SensorModel sensors(11, 2.0);
  double speed_squares = 0.0;
  double angle_squares = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const core::SensorReadings reading = sensors.measure(at_rest());
    speed_squares += reading.dq.squaredNorm();
    angle_squares += (reading.q.array() - 0.3).square().sum();
  }
  const double speed = std::sqrt(speed_squares / (kSamples * core::kJoints));
  const double angle = std::sqrt(angle_squares / (kSamples * core::kJoints));
  EXPECT_NEAR(speed / (2.0 * SensorErrors::kSpeedSigma), 1.0, kTolerance);
  EXPECT_NEAR(angle / (2.0 * SensorErrors::kAngleSigma), 1.0, kTolerance);
}

TEST(SensorModel, AnglesComeInWholeSteps) {
  SensorModel sensors(5, 1.0);
  const core::SensorReadings reading = sensors.measure(at_rest());
  for (const double angle : reading.q) {
    const double steps = angle / SensorErrors::kAngleStep;
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
  }
}

TEST(SensorModel, TheInertialSensorHasSixteenBits) {
  SensorModel sensors(5, 1.0);
  const core::SensorReadings reading = sensors.measure(at_rest());
  for (int axis = 0; axis < 3; ++axis) {
    const double rate = reading.w_WB_B[axis] / SensorErrors::kRateStep;
    const double force = reading.f_B[axis] / SensorErrors::kForceStep;
    EXPECT_NEAR(rate, std::round(rate), 1e-6);
    EXPECT_NEAR(force, std::round(force), 1e-6);
  }
}

TEST(SensorModel, BiasStaysInARunAndIsBounded) {
  constexpr int kSamples = 4000;
  const double of_the_mean = 5.0 * SensorErrors::kRateSigma / std::sqrt(kSamples);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SensorModel sensors(seed, 1.0);
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Vector3d second = Eigen::Vector3d::Zero();
    for (int i = 0; i < kSamples; ++i) first += sensors.measure(at_rest()).w_WB_B / kSamples;
    for (int i = 0; i < kSamples; ++i) second += sensors.measure(at_rest()).w_WB_B / kSamples;
    EXPECT_LT(first.cwiseAbs().maxCoeff(), SensorErrors::kRateBias + of_the_mean);
    EXPECT_LT((first - second).cwiseAbs().maxCoeff(), 2.0 * of_the_mean);
    EXPECT_GT(first.cwiseAbs().maxCoeff(), of_the_mean);  // some axis has a visible bias
  }
}

TEST(SensorModel, ImpactsSaturateTheAccelerometer) {
  SensorModel sensors(1, 0.0);
  core::SensorReadings truth = at_rest();
  truth.f_B = {-1000.0, 20.0, 400.0};
  truth.w_WB_B = {50.0, 0.0, -50.0};
  const core::SensorReadings reading = sensors.measure(truth);
  EXPECT_EQ(reading.f_B,
            Eigen::Vector3d(-SensorErrors::kForceRange, 20.0, SensorErrors::kForceRange));
  EXPECT_EQ(reading.w_WB_B,
            Eigen::Vector3d(SensorErrors::kRateRange, 0.0, -SensorErrors::kRateRange));
}

TEST(SensorModel, SameSeedSameReadings) {
  SensorModel a(42, 1.0);
  SensorModel b(42, 1.0);
  SensorModel c(43, 1.0);
  for (int i = 0; i < 10; ++i) {
    const core::SensorReadings reading = a.measure(at_rest());
    EXPECT_EQ(reading.q, b.measure(at_rest()).q);
    EXPECT_NE(reading.dq, c.measure(at_rest()).dq);
  }
}

}  // namespace
}  // namespace hopscotch::sim
