#pragma once

#include "core/config_reader.hpp"
#include "planner/decision_layout.hpp"

namespace hopscotch::planner {

/// Share of each physical limit that a plan may use; the rest belongs to the feedback.
struct Reserves {
  double torque = 0.0;    ///< Of the largest motor torque.
  double speed = 0.0;     ///< Of the largest motor speed, and of the torque-speed line with it.
  double power = 0.0;     ///< Of the motoring power.
  double friction = 0.0;  ///< Of the friction coefficient.
};

/// Weights of eq. (8) for one phase, each on the mean over the steps of the phase, so that they do
/// not depend on the number of steps.
struct CostWeights {
  double posture = 0.0;       ///< Q0, on (q - q_0)^2 of hip, knee, ankle [1/rad^2].
  double rate = 0.0;          ///< Q1, on dq^2 of hip, knee, ankle [s^2/rad^2].
  double torque = 0.0;        ///< Q2, on tau^2 of both legs together [1/(N·m)^2].
  double acceleration = 0.0;  ///< On the links' angular acceleration^2 [s^4/rad^2].
  double trunk_pitch = 0.0;   ///< On the trunk pitch against its final value [1/rad^2].
};

/// Tuning of JumpPlanner: section `planner` of the configuration.
struct PlannerConfig {
  StepCounts steps;
  double takeoff_first_step = 0.0;   ///< dt^t of the first takeoff step [s].
  double takeoff_last_step = 0.0;    ///< dt^t of the last one, just before lift-off [s].
  double flight_step_min = 0.0;      ///< Of dt^f [s].
  double flight_step_max = 0.0;      ///< Of dt^f [s].
  double landing_step_min = 0.0;     ///< Of dt^l, the mean step [s].
  double landing_step_max = 0.0;     ///< Of dt^l, the mean step, after an easy leap [s].
  double landing_step_hard = 0.0;    ///< The same after a hard one [s].
  double landing_first_share = 0.0;  ///< First landing step as a share of dt^l [-].
  double friction = 0.0;             ///< mu of the ground [-].
  Reserves reserves;
  double normal_force_min = 0.0;      ///< Of both feet while they stand [N].
  double normal_force_max = 0.0;      ///< Of both feet [N].
  double takeoff_cop_margin = 0.0;    ///< Kept from toe and heel [m].
  double landing_cop_margin = 0.0;    ///< Kept from toe and heel [m].
  double joint_margin = 0.0;          ///< Kept from the ends of the joint ranges [rad].
  double shank_pitch_max = 0.0;       ///< Of |pitch|: the knees must not scrape the ground [rad].
  double trunk_pitch_min = 0.0;       ///< [rad]
  double trunk_pitch_max = 0.0;       ///< [rad]
  double foot_pitch_max = 0.0;        ///< Of |pitch| in flight [rad].
  double clearance = 0.0;             ///< Of toe and heel in mid-flight [m].
  double knee_clearance = 0.0;        ///< Of the knee axis from the terrain [m].
  double touchdown_speed_down = 0.0;  ///< Largest of the sole [m/s].
  /// Smallest of the sole [m/s]: a foot that is not moving down misses ground that is a little low.
  double touchdown_speed_down_min = 0.0;
  double touchdown_speed_along = 0.0;  ///< Largest |speed| of the sole [m/s].
  double touchdown_foot_rate = 0.0;    ///< Largest |pitch rate| of the foot at touchdown [rad/s].
  CostWeights takeoff_cost;
  CostWeights flight_cost;
  CostWeights landing_cost;
  double rate_jump_cost = 0.0;   ///< On the jump of link rates at touchdown^2 [s^2/rad^2].
  double smoothness_cost = 0.0;  ///< On the change of angular acceleration between steps^2.
  double lateral_max = 0.0;      ///< Targets farther beside the jump line are refused [m].
  double yaw_max = 0.0;          ///< Targets turned more are refused [rad].
  int iterations_max = 0;
  double tolerance = 0.0;  ///< Of the scaled optimality conditions.

  /// Length of takeoff step `k`: from first to last in equal changes, since crouching is slow and
  /// the end of the push is fast [s].
  [[nodiscard]] double takeoff_step(int k) const;
  /// Landing step `k` as a share of dt^l; short after touchdown, long when all is calm. Mean 1.
  [[nodiscard]] double landing_share(int k) const;
  /// Upper bound of dt^l after a leap of `distance` and `height`: what the flight turned the trunk
  /// by, the landing has to turn back, and in a short one the soles then hop [m, m -> s].
  [[nodiscard]] double landing_step_longest(double distance, double height) const;
  /// Of the whole takeoff [s].
  [[nodiscard]] double takeoff_time() const;

  /// @throws core::ConfigError naming the key, its value and the violated rule.
  static PlannerConfig load(const core::ConfigReader& section);
};

}  // namespace hopscotch::planner
