#pragma once

#include "control/estimator_config.hpp"
#include "control/recovery_hop.hpp"
#include "control/wrench_mpc.hpp"
#include "core/ablation.hpp"
#include "core/config_reader.hpp"
#include "core/robot_layout.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// Joint PD of eq. (15), one leg; both legs have the same.
struct JointGains {
  core::LegVector kp;             ///< [N·m/rad]
  core::LegVector kd;             ///< [N·m·s/rad]
  double compliant_scale = 0.0;   ///< Factor on both where the MPC bears the load (landing, stand).
  double fallback_scale = 0.0;    ///< The same once the MPC has no fresh answer.
  double flight_share = 0.0;      ///< Of the trunk's deviation in flight that the hips take up.
  double placement_time = 0.0;    ///< Feet go so much further per excess speed of the CoM [s].
  double placement_dead = 0.0;    ///< Smaller deviations of that speed are left to the MPC [m/s].
  double placement_max = 0.0;     ///< Of the feet beside their planned place [m].
  double stretch_per_turn = 0.0;  ///< Legs reach down in flight by this much more per turn [m/rad]
  double stretch_dead = 0.0;      ///< of the trunk beyond this beside the plan [rad],
  double stretch_max = 0.0;       ///< at most [m].

  static JointGains load(const core::ConfigReader& section);
};

/// When phases change and when the robot gives up; section `control.supervisor`.
struct SupervisorConfig {
  double touchdown_from = 0.0;   ///< Share of the planned flight before which contact is ignored.
  double flight_overtime = 0.0;  ///< Flight longer than planned by this is a fault [s].
  double tilt_max = 0.0;         ///< Trunk away from upright; beyond is a fault [rad].
  double tilt_standing = 0.0;    ///< The same where the robot stands [rad].
  double joint_overshoot = 0.0;  ///< Beyond a joint range; more is a fault [rad].
  double joint_speed_max = 0.0;  ///< Any joint; more is a fault [rad/s].
  double joint_speed_standing = 0.0;  ///< The same where the robot stands [rad/s].
  double fall_time = 0.0;     ///< Standing with both feet unloaded for so long is falling [s].
  double rest_speed = 0.0;    ///< Of the trunk; slower is at rest [m/s].
  double rest_rate = 0.0;     ///< Of the trunk; slower is at rest [rad/s].
  double rest_early = 0.0;    ///< Before the end of a landing, a robot at rest stands already [s].
  double stray_max = 0.0;     ///< Of the capture point in a crouch; beyond, the jump is off [m].
  double commit_speed = 0.0;  ///< Planned rise of the CoM from which a jump must go on [m/s].

  static SupervisorConfig load(const core::ConfigReader& section);
};

/// Tuning of ControlTick: section `control` of the configuration.
struct ControlConfig {
  JointGains gains;
  SupervisorConfig supervisor;
  RecoveryHopConfig recovery_hop;
  double actuation_delay = 0.0;  ///< From the command's tick to torque at the joint, as known [s].
  double mpc_delay = 0.0;        ///< From the MPC's state to the tick that uses its answer [s].
  double wrench_age_max = 0.0;   ///< An MPC answer older than this is not used [s].
  double anchor_time = 0.0;  ///< After touchdown the landing follows the feet for this long [s].
  double settle_time = 0.0;  ///< From anywhere to a stand: switching on, calling a jump off [s].

  double fixed_step = 0.0;  ///< Of the MPC, where the ablation asks for a fixed frequency [s].
  core::Ablation ablation = core::Ablation::none;  ///< Set by the run, not by the configuration.

  WrenchMpcConfig wrench_mpc;
  EstimatorConfig estimator;

  /// @param mpc_delay The runtime's declared latency of the MPC [s].
  static ControlConfig load(const core::ConfigReader& section, double mpc_delay);
};

}  // namespace hopscotch::control
