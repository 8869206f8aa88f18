#pragma once

#include <string>

#include "core/robot_layout.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::sim {

/// What one sees of the robot: massless geoms of `kVisualGroup` that touch nothing. Shapes follow
/// the joint positions of the parameters; motor sizes are those of the Unitree A1 motor.

/// Children of <asset>.
[[nodiscard]] std::string look_materials();

/// Geoms of the trunk.
[[nodiscard]] std::string trunk_look(const model::RobotParameters& robot);

/// Geoms of the link that a joint moves.
[[nodiscard]] std::string link_look(const model::RobotParameters& robot, core::Leg leg,
                                    core::Joint joint);

}  // namespace hopscotch::sim
