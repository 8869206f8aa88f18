#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/robot_layout.hpp"
#include "core/sensor_readings.hpp"
#include "sim/random.hpp"

namespace hopscotch::sim {

/// Errors of the robot's sensors at 1 kHz, at noise scale 1. White noise unless said otherwise.
struct SensorErrors {
  /// 14-bit encoder on the motor shaft behind the 9.1:1 reduction [rad].
  static constexpr double kAngleStep = 6.283185307179586 / (16384.0 * 9.1);
  static constexpr double kAngleSigma = 2e-4;  ///< Belt and gear play that the step hides [rad].
  static constexpr double kSpeedSigma =
      0.03;  ///< Differentiated and filtered by the drive [rad/s].
  static constexpr double kTorqueSigma = 0.2;  ///< From the motor current [N·m].
  static constexpr double kRateSigma = 0.005;  ///< 1.6e-4 rad/s/sqrt(Hz), MEMS class [rad/s].
  static constexpr double kRateBias =
      0.005;                                 ///< At the start of a run, uniform in +- this [rad/s].
  static constexpr double kRateWalk = 1e-5;  ///< Of the bias [rad/s/sqrt(s)].
  static constexpr double kRateStep = 2.0 * 34.9 / 65536.0;  ///< 16 bits over the range [rad/s].
  static constexpr double kRateRange = 34.9;                 ///< 2000 deg/s, saturates [rad/s].
  static constexpr double kForceSigma = 0.05;                ///< [m/s^2]
  static constexpr double kForceBias = 0.05;  ///< At the start, uniform in +- this [m/s^2].
  static constexpr double kForceWalk = 1e-4;  ///< Of the bias [m/s^2/sqrt(s)].
  static constexpr double kForceStep = 2.0 * 156.9 / 65536.0;  ///< 16 bits [m/s^2].
  static constexpr double kForceRange = 156.9;  ///< 16 g, saturates in impacts [m/s^2].
};

/// Turns true values into readings: encoders, currents and IMU with noise, bias, steps and range.
class SensorModel {
 public:
  /// @param scale Multiplies every error but the ranges; 0 is a perfect sensor.
  SensorModel(std::uint64_t seed, double scale);

  /// @param truth The true values of this tick.
  /// @return What the sensors say; one draw of noise and 1 ms of bias walk per call.
  [[nodiscard]] core::SensorReadings measure(const core::SensorReadings& truth);

 private:
  double scale_;
  Random random_;
  Eigen::Vector3d rate_bias_;   // [rad/s]
  Eigen::Vector3d force_bias_;  // [m/s^2]
};

}  // namespace hopscotch::sim
