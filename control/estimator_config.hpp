#pragma once

#include "core/config_reader.hpp"

namespace hopscotch::control {

/// What the filter believes of sensors and feet: section `control.estimator`. Densities are of
/// white noise: its standard deviation after one second of integration.
struct FilterConfig {
  double gyro_density = 0.0;              ///< [rad/s/sqrt(Hz)]
  double gyro_walk = 0.0;                 ///< Of its bias [rad/s/sqrt(s)].
  double accelerometer_density = 0.0;     ///< [m/s^2/sqrt(Hz)]
  double accelerometer_walk = 0.0;        ///< Of its bias [m/s^2/sqrt(s)].
  double accelerometer_range = 0.0;       ///< Readings beyond say only "more" [m/s^2].
  double saturated_sigma = 0.0;           ///< Of such a reading [m/s^2].
  double gyro_bias_sigma = 0.0;           ///< At start-up [rad/s].
  double accelerometer_bias_sigma = 0.0;  ///< At start-up [m/s^2].
  double start_tilt_sigma = 0.0;          ///< Of level soles at start-up [rad].
  double start_speed_sigma = 0.0;         ///< At start-up [m/s].
  double encoder_sigma = 0.0;             ///< Of one joint angle [rad].
  double foot_sigma = 0.0;                ///< Of a sole's place: compliance, model [m].
  double foot_density = 0.0;              ///< A standing foot creeps [m/sqrt(s)].
  double impact_density = 0.0;            ///< More of it right after touchdown [m/sqrt(s)].
  double impact_time = 0.0;               ///< In which that fades [s].
  double roll_density = 0.0;  ///< More of it per turning rate of the foot [m/sqrt(s)/(rad/s)].
  double gate = 0.0;          ///< Squared sigmas beyond which a foot has slipped.
  double height_sigma = 0.0;  ///< Of a map height [m].
  double height_gate = 0.0;   ///< Squared sigmas beyond which a map height is not believed.
};

/// When a foot counts as bearing load: section `control.contact`.
struct ContactConfig {
  double residual_rate = 0.0;    ///< Bandwidth of the momentum residual [1/s].
  double support_force = 0.0;    ///< Vertical force that is contact where it is expected [N].
  double touchdown_force = 0.0;  ///< The same where touchdown is due [N].
  double airborne_force = 0.0;   ///< The same in early flight [N].
  double spike_force = 0.0;  ///< Vertical impulse of one tick over its length that is contact [N].
  double lost_force = 0.0;   ///< Less than this for `lost_time` is no contact [N].
  double lost_time = 0.0;    ///< [s]
  double leave_time = 0.0;   ///< Before lift-off, from which on feet are not trusted [s].
};

/// When a flight is believed to have gone wrong: section `control.estimator.flight_check`.
struct FlightCheckConfig {
  double settle_time = 0.0;  ///< After touchdown, until the soles have come to rest [s].
  double watch_time = 0.0;   ///< For so long they are watched then, twice [s].
  double speed_max = 0.0;    ///< Vertical speed off by so much is no noise [m/s].
};

struct EstimatorConfig {
  FilterConfig filter;
  FlightCheckConfig flight_check;
  ContactConfig contact;

  static EstimatorConfig load(const core::ConfigReader& section);
};

}  // namespace hopscotch::control
