#pragma once

#include "model/robot_parameters.hpp"

namespace hopscotch::model {

/// One link of the sagittal chain, both legs lumped. Link frame: z along the straight leg, upward
/// from the lower joint; x forward.
struct PlanarLink {
  double mass = 0.0;     ///< [kg]
  double com_x = 0.0;    ///< From the lower joint [m].
  double com_z = 0.0;    ///< From the lower joint [m].
  double inertia = 0.0;  ///< About the link's CoM [kg·m^2].
  double length = 0.0;   ///< Lower joint to upper joint [m]; 0 for the trunk and the foot.
};

/// The robot in the sagittal plane: foot, shank, thigh, trunk (trunk = body with hip brackets and
/// hip motors), legs side by side. Signs: absolute link pitches about +y (+ = nose down), so that
/// with joint angles of one leg  shank = foot - q_ankle,  thigh = shank - q_knee,  trunk = thigh -
/// q_hip.
struct PlanarChain {
  PlanarLink foot;              ///< Origin: ankle axis.
  PlanarLink shank;             ///< Origin: ankle axis.
  PlanarLink thigh;             ///< Origin: knee axis.
  PlanarLink trunk;             ///< Origin: hip-pitch axis.
  double trunk_x = 0.0;         ///< Trunk origin B ahead of the hip-pitch axis [m].
  double trunk_z = 0.0;         ///< Trunk origin B above the hip-pitch axis [m].
  double sole_height = 0.0;     ///< Ankle axis above the sole [m].
  double toe = 0.0;             ///< Toe ahead of the ankle axis [m].
  double heel = 0.0;            ///< Heel behind the ankle axis, positive [m].
  double armature_hip = 0.0;    ///< Both legs [kg·m^2].
  double armature_knee = 0.0;   ///< Knee motors' own, both legs: acts on dq_knee [kg·m^2].
  double armature_ankle = 0.0;  ///< Ankle motors', both legs: acts on dq_knee + dq_ankle [kg·m^2].
  double damping_hip = 0.0;     ///< Both legs [N·m·s/rad].
  double damping_knee = 0.0;    ///< Both legs [N·m·s/rad].
  double damping_ankle = 0.0;   ///< Both legs [N·m·s/rad].

  [[nodiscard]] double total_mass() const {
    return foot.mass + shank.mass + thigh.mass + trunk.mass;
  }
};

/// Lumps the two legs at zero yaw and roll into the sagittal chain.
[[nodiscard]] PlanarChain lump_legs(const RobotParameters& robot);

}  // namespace hopscotch::model
