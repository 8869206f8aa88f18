#pragma once

#include <Eigen/Core>
#include <array>

#include "core/robot_layout.hpp"

namespace hopscotch::core {

/// Wrench of the ground on one foot, taken at the sole centre F, expressed in W.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< [N·m]
};

/// One wrench per leg; a foot without contact has zero.
using ContactWrenches = std::array<Wrench, kLegs>;

}  // namespace hopscotch::core
