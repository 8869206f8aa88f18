#pragma once

#include <mujoco/mujoco.h>

#include <array>

#include "core/robot_layout.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::sim {

/// The ankle motors sit on the thighs and turn with q_knee + q_ankle, so that their reflected
/// inertia J adds [[J, J], [J, J]] to the (knee, ankle) block of the mass matrix. The diagonal is
/// in the `armature` of the model from `robot_builder`; this adds the rest, exactly: J is constant,
/// hence it brings no velocity terms.
class AnkleCoupling {
 public:
  /// @param model Compiled from `robot_xml` of the same robot.
  AnkleCoupling(const mjModel& model, const model::RobotParameters& robot);

  /// As mj_forward, mj_step (Euler), with the coupled mass matrix in `data.qM`.
  void forward(const mjModel& model, mjData& data) const;
  void step(const mjModel& model, mjData& data) const;

 private:
  void couple(const mjModel& model, mjData& data) const;

  double inertia_;                             // J [kg·m^2]
  std::array<int, core::kLegs> mass_address_;  // of M(ankle, knee) in qM
};

}  // namespace hopscotch::sim
