#pragma once

#include <Eigen/Core>

#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::model {

/// The robot as one body: whole-body CoM G, its velocity, and the inertia of the present posture as
/// if all joints were locked. The state of the MPC, eqs. (5)-(6) in 3-D.
struct CompositeBody {
  double mass = core::kNaN;                                      ///< [kg]
  Eigen::Vector3d p_WG = Eigen::Vector3d::Constant(core::kNaN);  ///< [m]
  Eigen::Vector3d v_WG = Eigen::Vector3d::Constant(core::kNaN);  ///< [m/s]
  Eigen::Matrix3d inertia_W =
      Eigen::Matrix3d::Constant(core::kNaN);  ///< About G, axes of W [kg·m^2].
  Eigen::Vector3d momentum_W =
      Eigen::Vector3d::Constant(core::kNaN);  ///< Angular, about G, in W [kg·m^2/s].
};

/// Composite body of the present posture and motion. Real-time safe.
[[nodiscard]] CompositeBody composite_body(const RobotParameters& robot,
                                           const core::RobotState& state);

}  // namespace hopscotch::model
