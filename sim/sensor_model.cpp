#include "sim/sensor_model.hpp"

#include <cmath>

namespace hopscotch::sim {
namespace {

constexpr std::uint64_t kStream = 0x5E;  // the sensors' own stream of random numbers

double rounded_to(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

Eigen::Vector3d saturated(const Eigen::Vector3d& value, double range) {
  return value.cwiseMax(-range).cwiseMin(range);
}

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
  reading.w_WB_B += rate_bias_ + scale_ * SensorErrors::kRateSigma * random_.normal_vector<3>();
  reading.w_WB_B = saturated(reading.w_WB_B, SensorErrors::kRateRange);
  reading.f_B += force_bias_ + scale_ * SensorErrors::kForceSigma * random_.normal_vector<3>();
  reading.f_B = saturated(reading.f_B, SensorErrors::kForceRange);
  return reading;
}

}  // namespace hopscotch::sim
