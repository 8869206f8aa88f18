#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "core/robot_layout.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::model {

/// Poses of one leg's links in B: hip, hip2, thigh, shank, foot. Frame F is the sole centre.
struct LegPoses {
  std::array<Eigen::Isometry3d, core::kJointsPerLeg> X_BL;  ///< Link frames.
  Eigen::Isometry3d X_BF;                                   ///< Sole centre.
};

/// Forward kinematics of one leg. Real-time safe.
[[nodiscard]] LegPoses leg_poses(const RobotParameters& robot, core::Leg leg,
                                 const core::LegVector& q);

/// Geometric Jacobian of the sole centre in B: [v_BF; w_BF] = J dq, linear rows first. Real-time
/// safe.
[[nodiscard]] Eigen::Matrix<double, 6, core::kJointsPerLeg> sole_jacobian(
    const RobotParameters& robot, core::Leg leg, const core::LegVector& q);

/// Pose of each sole in W. Real-time safe.
[[nodiscard]] std::array<Eigen::Isometry3d, core::kLegs> sole_poses(const RobotParameters& robot,
                                                                    const core::RobotState& state);

/// Toe and heel tips of one foot in W, on the sole's centre line [m]. Real-time safe.
struct SoleTips {
  Eigen::Vector3d toe;
  Eigen::Vector3d heel;
};
[[nodiscard]] SoleTips sole_tips(const RobotParameters& robot, const Eigen::Isometry3d& X_WF);

/// Hip pitch, knee and ankle angles that put the sole centre of a leg with zero yaw and roll at
/// `p_BF` (y is ignored) with the sole pitched by `sole_pitch` [rad, + toe down] in B; knee
/// backward. Nothing if the place is out of reach of the leg; joint ranges are the caller's
/// business. Real-time safe.
[[nodiscard]] std::optional<core::LegVector> leg_inverse_kinematics(const RobotParameters& robot,
                                                                    const Eigen::Vector3d& p_BF,
                                                                    double sole_pitch);

/// Roll, pitch, yaw with R = Rz Ry Rx [rad].
[[nodiscard]] Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R);
[[nodiscard]] Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy);
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& v);

}  // namespace hopscotch::model
