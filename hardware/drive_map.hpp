#pragma once

#include <array>

#include "core/joint_command.hpp"
#include "hardware/bus_topology.hpp"
#include "hardware/motor_protocol.hpp"

/// Between joints and the shafts of their drives: signs, zero offsets, reductions and the linkage
/// that makes the ankle's motor turn with knee plus ankle. Pure and real-time safe.
namespace hopscotch::hardware {

/// What the shafts say, one per joint in joint order.
struct ShaftStates {
  std::array<double, core::kJoints> position{};  ///< [rad]
  std::array<double, core::kJoints> speed{};     ///< [rad/s]
  std::array<double, core::kJoints> torque{};    ///< [N·m]
};

struct JointStates {
  core::JointVector q;    ///< [rad]
  core::JointVector dq;   ///< [rad/s]
  core::JointVector tau;  ///< Joint side [N·m].
};

[[nodiscard]] JointStates joint_states(const BusTopology& topology, const ShaftStates& shafts);
[[nodiscard]] ShaftStates shaft_states(const BusTopology& topology, const JointStates& joints);

/// Set-points for the drives. A drive's PD knows its own motor only, but the PD asked for acts on
/// joints: at the knee and ankle the stiffness matrix in motor angles has off-diagonal terms. Their
/// share at the reading (q, dq) goes into the feed-forward; the diagonal closes in the drives. At
/// the reading the torques are then exactly those asked for.
/// Damping (`DriveMode::damp`) is each motor's own: it takes energy whatever the reading says.
[[nodiscard]] std::array<DriveSetpoint, core::kJoints> drive_setpoints(
    const BusTopology& topology, const core::JointCommand& command, const core::JointVector& q,
    const core::JointVector& dq);

}  // namespace hopscotch::hardware
