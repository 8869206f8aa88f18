#pragma once

#include <Eigen/Core>

#include "control/wrench_mpc.hpp"
#include "control/wrench_qp.hpp"
#include "core/control_reference.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

/// Internal to wrench_mpc: writes the QP of eqs. (13)-(14) for one moment. docs/wrench_mpc.md,
/// section 2.
namespace hopscotch::control {

/// Frame H of one solve: origin at the reference CoM of knot 0, z up, x along the reference yaw of
/// knot 0. In it the weights act along the jump and sideways, wherever in W the robot heads.
struct Heading {
  Eigen::Vector3d p_WH;
  Eigen::Matrix3d R_HW;
  double yaw;  ///< [rad]
};
[[nodiscard]] Heading heading_of(const core::ControlReference& reference) noexcept;

/// Whether every number that the QP needs is finite and in its range.
[[nodiscard]] bool can_pose(const core::RobotState& state, const core::ControlReference& reference,
                            int horizon_max) noexcept;

/// The parts of the QP that the configuration fixes: weights, cone, step rule.
[[nodiscard]] WrenchQp constant_part(const WrenchMpcConfig& config,
                                     const model::RobotParameters& robot);

/// Fills what changes from call to call, in H. @pre can_pose(). Real-time safe.
void pose_problem(const model::RobotParameters& robot, const core::RobotState& state,
                  const core::ControlReference& reference, MpcForm form, WrenchQp& qp) noexcept;

/// T with d(rpy)/dt = T w for R = Rz Ry Rx and w in the outer frame; |pitch| < pi / 2.
[[nodiscard]] Eigen::Matrix3d rpy_rate(const Eigen::Vector3d& rpy) noexcept;

/// The wrench in W of a foot whose frame has this yaw in W [rad].
[[nodiscard]] core::Wrench foot_wrench(const FootInput& input, double yaw) noexcept;
/// The inverse; Mx, which a foot cannot give, is dropped.
[[nodiscard]] FootInput foot_input(const core::Wrench& wrench, double yaw) noexcept;

}  // namespace hopscotch::control
