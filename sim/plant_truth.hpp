#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "core/contact_wrenches.hpp"
#include "core/robot_state.hpp"
#include "model/motor.hpp"

namespace hopscotch::sim {

/// Something other than a foot that touches the terrain.
struct BodyContact {
  std::string part;                               ///< Link, e.g. "left_shank".
  std::string ground;                             ///< Geom of the terrain, e.g. "slab3.top".
  double normal_force = 0.0;                      ///< [N]
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m]
};

/// What really happens in the simulated world. For judging, reports and `--state truth`; a
/// controller on estimated state never sees it.
struct PlantTruth {
  core::RobotState state;  ///< Contact: the foot's normal force exceeds `kContactForce`.
  std::array<Eigen::Isometry3d, core::kLegs> X_WF;            ///< Sole poses.
  core::ContactWrenches ground;                               ///< During the last tick.
  core::JointVector tau = core::JointVector::Zero();          ///< Applied in the last tick [N·m].
  std::array<model::MotorLoad, core::kLegs> load;             ///< Of `tau` at the speed it met.
  core::JointVector motor_power = core::JointVector::Zero();  ///< + motoring, - braking [W].
  std::vector<BodyContact> body_contacts;                     ///< Usually empty.
  bool foot_in_pit = false;                                   ///< A foot touches the pit's floor.
};

/// A foot that carries more than this stands [N].
inline constexpr double kContactForce = 15.0;

}  // namespace hopscotch::sim
