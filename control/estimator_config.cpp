#include "control/estimator_config.hpp"

namespace hopscotch::control {

using core::Range;

namespace {

FilterConfig load_filter(const core::ConfigReader& section) {
  const Range positive = Range::positive();
  FilterConfig c;
  c.gyro_density = section.number("gyro_density_rad_s_sqrtHz", positive);
  c.gyro_walk = section.number("gyro_walk_rad_s_sqrts", positive);
  c.accelerometer_density = section.number("accelerometer_density_mps2_sqrtHz", positive);
  c.accelerometer_walk = section.number("accelerometer_walk_mps2_sqrts", positive);
  c.accelerometer_range = section.number("accelerometer_range_mps2", positive);
  c.saturated_sigma = section.number("saturated_sigma_mps2", positive);
  c.gyro_bias_sigma = section.number("gyro_bias_sigma_rad_s", positive);
  c.accelerometer_bias_sigma = section.number("accelerometer_bias_sigma_mps2", positive);
  c.start_tilt_sigma = section.number("start_tilt_sigma_rad", positive);
  c.start_speed_sigma = section.number("start_speed_sigma_mps", positive);
  c.encoder_sigma = section.number("encoder_sigma_rad", positive);
  c.foot_sigma = section.number("foot_sigma_m", positive);
  c.foot_density = section.number("foot_density_m_sqrts", positive);
  c.impact_density = section.number("impact_density_m_sqrts", positive);
  c.impact_time = section.number("impact_time_s", positive);
  c.roll_density = section.number("roll_density_m_sqrts_per_rad_s", Range::closed(0.0, 1.0));
  c.gate = section.number("gate_sigmas2", positive);
  c.height_sigma = section.number("height_sigma_m", positive);
  c.height_gate = section.number("height_gate_sigmas2", positive);
  section.finish();
  return c;
}

ContactConfig load_contact(const core::ConfigReader& section) {
  const Range force = Range::above(0.0, 1000.0);
  ContactConfig c;
  c.residual_rate = section.number("residual_rate_per_s", Range::closed(10.0, 500.0));
  c.support_force = section.number("support_force_N", force);
  c.touchdown_force = section.number("touchdown_force_N", force);
  c.airborne_force = section.number("airborne_force_N", force);
  c.spike_force = section.number("spike_force_N", force);
  c.lost_force = section.number("lost_force_N", force);
  c.lost_time = section.number("lost_time_s", Range::closed(0.0, 0.2));
  c.leave_time = section.number("leave_time_s", Range::closed(0.0, 0.1));
  section.finish();
  return c;
}

FlightCheckConfig load_flight_check(const core::ConfigReader& section) {
  FlightCheckConfig c;
  c.settle_time = section.number("settle_time_s", Range::closed(0.0, 0.2));
  c.watch_time = section.number("watch_time_s", Range::closed(0.005, 0.2));
  c.speed_max = section.number("speed_max_mps", Range::positive());
  section.finish();
  return c;
}

}  // namespace

EstimatorConfig EstimatorConfig::load(const core::ConfigReader& section) {
  EstimatorConfig config;
  config.filter = load_filter(section.section("filter"));
  config.flight_check = load_flight_check(section.section("flight_check"));
  config.contact = load_contact(section.section("contact"));
  section.finish();
  return config;
}

}  // namespace hopscotch::control
