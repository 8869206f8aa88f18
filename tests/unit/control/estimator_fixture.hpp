#pragma once

#include "control/control_config.hpp"

namespace hopscotch::control::testing {

/// Estimator tuning for tests; the numbers are those of a good sensor.
inline EstimatorConfig estimator_config() {
  EstimatorConfig config;
  config.filter = {.gyro_density = 3e-4,
                   .gyro_walk = 2e-5,
                   .accelerometer_density = 4e-3,
                   .accelerometer_walk = 2e-4,
                   .accelerometer_range = 155.0,
                   .saturated_sigma = 100.0,
                   .gyro_bias_sigma = 0.004,
                   .accelerometer_bias_sigma = 0.04,
                   .start_tilt_sigma = 0.05,
                   .start_speed_sigma = 0.05,
                   .encoder_sigma = 3e-4,
                   .foot_sigma = 2e-4,
                   .foot_density = 0.002,
                   .impact_density = 0.05,
                   .impact_time = 0.02,
                   .roll_density = 0.005,
                   .gate = 36.0,
                   .height_sigma = 0.006,
                   .height_gate = 6.0};
  config.flight_check = {.settle_time = 0.02, .watch_time = 0.01, .speed_max = 0.08};
  config.contact = {.residual_rate = 250.0,
                    .support_force = 30.0,
                    .touchdown_force = 40.0,
                    .airborne_force = 150.0,
                    .spike_force = 150.0,
                    .lost_force = 15.0,
                    .lost_time = 0.006,
                    .leave_time = 0.015};
  return config;
}

}  // namespace hopscotch::control::testing
