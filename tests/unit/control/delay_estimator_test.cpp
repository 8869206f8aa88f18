#include "control/delay_estimator.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>

namespace hopscotch::control {
namespace {

constexpr double kTick = 0.001;

/// Drives that obey `delay` exchanges late, joints that hold still but for encoder noise.
std::optional<double> estimate(int delay, double noise, int exchanges) {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal(0.0, 1.0);
  DelayEstimator estimator;
  std::deque<core::JointCommand> under_way(static_cast<std::size_t>(delay));
  core::SensorReadings readings;
  readings.q.setZero();
  readings.dq.setZero();
  readings.tau.setZero();
  for (int n = 0; n < exchanges; ++n) {
    readings.stamp = core::Stamp::from_seconds(kTick * n);
    estimator.received(readings);
    core::JointCommand command;
    command.stamp = readings.stamp;
    command.mode = core::DriveMode::active;
    command.kp.setConstant(60.0);
    command.kd.setConstant(1.0);
    // Feed-forward changes with each answer of the MPC.
    command.tau.setConstant(5.0 + std::sin(0.4 * (n / 5)));
    command.q.setConstant(0.02 * std::sin(0.01 * n));
    estimator.sent(command);
    under_way.push_back(command);
    const core::JointCommand& acting = under_way.front();
    readings.tau = acting.tau + acting.kp.cwiseProduct(acting.q - readings.q) -
                   acting.kd.cwiseProduct(readings.dq);
    for (double& torque : readings.tau) torque += noise * normal(rng);
    under_way.pop_front();
    for (double& angle : readings.q) angle = 2e-4 * normal(rng);
  }
  return estimator.delay();
}

TEST(DelayEstimator, FindsEachDelayInNoise) {
  for (int delay = 0; delay <= 8; ++delay) {
    const std::optional<double> found = estimate(delay, 0.2, 600);
    ASSERT_TRUE(found.has_value()) << delay;
    EXPECT_NEAR(*found, kTick * delay, 1e-9);
  }
}

TEST(DelayEstimator, SaysNothingTooEarlyOrWhenNothingFits) {
  EXPECT_FALSE(estimate(2, 0.2, 100).has_value());
  EXPECT_FALSE(estimate(2, 50.0, 600).has_value());
}

}  // namespace
}  // namespace hopscotch::control
