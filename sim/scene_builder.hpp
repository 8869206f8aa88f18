#pragma once

#include <string>

#include "model/robot_parameters.hpp"
#include "sim/terrain.hpp"

namespace hopscotch::sim {

/// The whole simulated world as one MJCF document: robot, terrain, light, 1 ms step. Generalised
/// positions: free joint of the trunk (p_WB, quaternion w x y z), then core::JointVector.
[[nodiscard]] std::string scene_mjcf(const model::RobotParameters& robot, const Terrain& terrain);

}  // namespace hopscotch::sim
