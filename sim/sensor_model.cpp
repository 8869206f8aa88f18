#include "sim/sensor_model.hpp"

#include <cmath>

namespace hopscotch::sim {
namespace {

constexpr std::uint64_t kStream = 0x5E;  // the sensors' own stream of random numbers

double rounded_to(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

Eigen::Vector3d digitised(const Eigen::Vector3d& value, double step, double range) {
  return value.unaryExpr([&](double x) { return rounded_to(x, step); })
      .cwiseMax(-range)
      .cwiseMin(range);
}

constexpr double kTick = 0.001;  // [s] between calls

}  // namespace

SensorModel::SensorModel(std::uint64_t seed, double scale)
    : scale_(scale), random_(Random::stream(seed, kStream)) {
  rate_bias_ = scale * SensorErrors::kRateBias * random_.uniform_vector<3>();
  force_bias_ = scale * SensorErrors::kForceBias * random_.uniform_vector<3>();
}

core::SensorReadings SensorModel::measure(const core::SensorReadings& truth) {
  core::SensorReadings reading = truth;
  reading.q += scale_ * SensorErrors::kAngleSigma * random_.normal_vector<core::kJoints>();
  for (double& angle : reading.q) angle = rounded_to(angle, scale_ * SensorErrors::kAngleStep);
  reading.dq += scale_ * SensorErrors::kSpeedSigma * random_.normal_vector<core::kJoints>();
  reading.tau += scale_ * SensorErrors::kTorqueSigma * random_.normal_vector<core::kJoints>();
  const double walked = scale_ * std::sqrt(kTick);
  rate_bias_ += walked * SensorErrors::kRateWalk * random_.normal_vector<3>();
  force_bias_ += walked * SensorErrors::kForceWalk * random_.normal_vector<3>();
  reading.w_WB_B += rate_bias_ + scale_ * SensorErrors::kRateSigma * random_.normal_vector<3>();
  reading.w_WB_B =
      digitised(reading.w_WB_B, scale_ * SensorErrors::kRateStep, SensorErrors::kRateRange);
  reading.f_B += force_bias_ + scale_ * SensorErrors::kForceSigma * random_.normal_vector<3>();
  reading.f_B =
      digitised(reading.f_B, scale_ * SensorErrors::kForceStep, SensorErrors::kForceRange);
  return reading;
}

}  // namespace hopscotch::sim
