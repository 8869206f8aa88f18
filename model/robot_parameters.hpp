#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>

#include "core/robot_layout.hpp"

namespace hopscotch::model {

/// Mass properties of one rigid link in its own link frame (axes parallel to B with a straight
/// leg).
struct LinkParameters {
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();      ///< From the link origin [m].
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< About the link's CoM [kg·m^2].
};

/// One joint of the LEFT leg and the link that it moves; the right leg is the mirror image (y ->
/// -y; axes keep their sign).
struct JointParameters {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< In the parent link's frame [m].
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();    ///< Unit vector in the parent link's frame.
  double lower = 0.0;                                ///< Left leg [rad].
  double upper = 0.0;                                ///< Left leg [rad].
  double damping = 0.0;                              ///< Viscous [N·m·s/rad].
  double friction = 0.0;                             ///< Coulomb [N·m].
  LinkParameters link;
};

/// Limits of one motor, referred to the joint side of its own reduction. Set R: equal motors; the
/// knee motor's reduction is twice the others' and the ankle motor acts on q_knee + q_ankle.
struct MotorParameters {
  double torque_max = 0.0;    ///< [N·m]
  double speed_max = 0.0;     ///< Motoring torque is zero from here on [rad/s].
  double corner_speed = 0.0;  ///< Full torque up to here (torque-speed line) [rad/s].
  double armature = 0.0;      ///< Reflected rotor inertia [kg·m^2].
};

/// Everything that is true of one HECTOR variant: file `config/robots/<name>.yaml`.
struct RobotParameters {
  std::string name;
  LinkParameters trunk;  ///< Origin of B is the trunk's CoM, so `com` is zero.
  std::array<JointParameters, core::kJointsPerLeg> joints;  ///< Left leg, `core::Joint` order.
  Eigen::Vector3d sole =
      Eigen::Vector3d::Zero();  ///< Sole point below the ankle, in the foot link [m].
  double toe = 0.0;             ///< Toe ahead of the ankle axis, along the sole [m].
  double heel = 0.0;            ///< Heel behind the ankle axis, along the sole [m], positive.
  double foot_width = 0.0;      ///< [m]
  std::array<MotorParameters, core::kJointsPerLeg> motors;  ///< `core::Joint` order.
  double motor_power_max = 0.0;                         ///< Mechanical, motoring, per motor [W].
  double braking_power_max = 0.0;                       ///< Mechanical, braking, per motor [W].
  Eigen::Vector3d trunk_box = Eigen::Vector3d::Zero();  ///< Full extents, centred at B [m].
  double shank_radius = 0.0;                            ///< Capsule along the shank [m].
  double thigh_radius = 0.0;                            ///< Capsule along the thigh [m].

  /// @throws core::ConfigError naming the key, its value and the violated rule.
  static RobotParameters load(const std::filesystem::path& file);

  [[nodiscard]] double total_mass() const;    ///< [kg]
  [[nodiscard]] double thigh_length() const;  ///< Hip-pitch axis to knee axis, sagittal [m].
  [[nodiscard]] double shank_length() const;  ///< Knee axis to ankle axis, sagittal [m].
  /// Sole centre F ahead of the ankle axis [m]: (toe - heel) / 2.
  [[nodiscard]] double sole_centre() const { return 0.5 * (toe - heel); }
};

/// Limits of one joint angle with the mirror rule applied (roll and yaw ranges swap sign on the
/// right).
struct JointRange {
  double lower = 0.0;  ///< [rad]
  double upper = 0.0;  ///< [rad]
};
[[nodiscard]] JointRange joint_range(const RobotParameters& robot, core::Leg leg,
                                     core::Joint joint);

}  // namespace hopscotch::model
