#pragma once

#include "control/wrench_mpc.hpp"
#include "control/wrench_qp.hpp"
#include "core/contact_wrenches.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// The torque rows of the MPC, kept after its QP instead of in it: of the wrenches that it chose,
/// those that the motors cannot hold at the present posture and joint speeds are replaced by the
/// nearest ones that they can hold and the contact too. For each leg
///
///   min |T^-1 M J' (u - u_asked)|^2
///   s.t. lower(dq) <= M (tau_base - J' u) <= upper(dq),   u in the cone of eqs. (14b) to (14e),
///
/// with M from joints to motors (linkage) and T = diag(torque_max): what a drive's own clipping
/// would leave, as long as that is in the cone. Why not in the QP, and figures:
/// docs/decisions/0151. Real-time safe.
class WrenchLimiter {
 public:
  WrenchLimiter(const WrenchMpcConfig& config, const model::RobotParameters& robot);

  /// Replaces what is out of reach; the rest is left as it is, to the bit.
  /// @param base     Joint torques that act whatever the feet bear: weight of the legs, joint PD
  ///                 [N·m]. A motor for which they are too much by themselves only gets no more.
  /// @param wrenches Ground on foot at the sole centre, in W; in the cone of the MPC.
  /// @return joint torques that bear what `wrenches` are now (contact_torques) [N·m].
  core::JointVector limit(const core::RobotState& state, const core::JointVector& base,
                          core::ContactWrenches& wrenches) const noexcept;

 private:
  model::RobotParameters robot_;
  WrenchCone cone_;
};

}  // namespace hopscotch::control
