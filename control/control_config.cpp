#include "control/control_config.hpp"

namespace hopscotch::control {

using core::Range;

JointGains JointGains::load(const core::ConfigReader& section) {
  JointGains gains;
  gains.kp = section.vector<core::kJointsPerLeg>("kp_Nm_rad", Range::closed(0.0, 500.0));
  gains.kd = section.vector<core::kJointsPerLeg>("kd_Nms_rad", Range::closed(0.0, 5.0));
  gains.compliant_scale = section.number("compliant_scale", Range::closed(0.0, 1.0));
  gains.fallback_scale = section.number("fallback_scale", Range::closed(0.0, 1.0));
  gains.flight_share = section.number("flight_share", Range::closed(0.0, 3.0));
  gains.placement_time = section.number("placement_time_s", Range::closed(0.0, 0.5));
  gains.placement_dead = section.number("placement_dead_mps", Range::not_negative());
  gains.placement_max = section.number("placement_max_m", Range::closed(0.0, 0.15));
  gains.stretch_per_turn = section.number("stretch_per_turn_m_rad", Range::not_negative());
  gains.stretch_dead = section.number("stretch_dead_rad", Range::not_negative());
  gains.stretch_max = section.number("stretch_max_m", Range::closed(0.0, 0.1));
  section.finish();
  return gains;
}

SupervisorConfig SupervisorConfig::load(const core::ConfigReader& section) {
  SupervisorConfig config;
  config.touchdown_from = section.number("touchdown_from", Range::closed(0.0, 1.0));
  config.flight_overtime = section.number("flight_overtime_s", Range::closed(0.0, 1.0));
  config.tilt_max = section.number("tilt_max_rad", Range::above(0.0, 1.57));
  config.tilt_standing = section.number("tilt_standing_rad", Range::above(0.0, 1.57));
  config.joint_overshoot = section.number("joint_overshoot_rad", Range::closed(0.0, 1.0));
  config.joint_speed_max = section.number("joint_speed_max_rad_s", Range::positive());
  config.joint_speed_standing = section.number("joint_speed_standing_rad_s", Range::positive());
  config.fall_time = section.number("fall_time_s", Range::above(0.0, 1.0));
  config.rest_speed = section.number("rest_speed_mps", Range::positive());
  config.rest_rate = section.number("rest_rate_rad_s", Range::positive());
  config.rest_early = 1e-3 * section.number("rest_early_ms", Range::closed(0.0, 100.0));
  config.stray_max = section.number("stray_max_m", Range::positive());
  config.commit_speed = section.number("commit_speed_mps", Range::closed(0.0, 1.0));
  section.finish();
  return config;
}

ControlConfig ControlConfig::load(const core::ConfigReader& section, double mpc_delay) {
  ControlConfig config;
  config.mpc_delay = mpc_delay;
  config.gains = JointGains::load(section.section("gains"));
  config.supervisor = SupervisorConfig::load(section.section("supervisor"));
  config.recovery_hop = RecoveryHopConfig::load(section.section("recovery_hop"));
  config.actuation_delay = 1e-3 * section.number("actuation_delay_ms", Range::closed(0.0, 20.0));
  config.wrench_age_max = 1e-3 * section.number("wrench_age_max_ms", Range::closed(1.0, 200.0));
  config.anchor_time = section.number("anchor_time_s", Range::closed(0.0, 1.0));
  config.fixed_step = 1e-3 * section.number("fixed_step_ms", Range::closed(2.0, 100.0));
  config.settle_time = section.number("settle_time_s", Range::above(0.0, 3.0));
  config.wrench_mpc = WrenchMpcConfig::load(section.section("wrench_mpc"));
  config.estimator = EstimatorConfig::load(section.section("estimator"));
  section.finish();
  return config;
}

}  // namespace hopscotch::control
