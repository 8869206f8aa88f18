#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/robot_layout.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::apps {

/// The robot as seen from the side: points (x, z) of W [m].
struct StickFigure {
  std::array<Eigen::Vector2d, 4> trunk;  ///< Corners of its box.
  struct LegPoints {
    Eigen::Vector2d hip;
    Eigen::Vector2d knee;
    Eigen::Vector2d ankle;
    Eigen::Vector2d toe;
    Eigen::Vector2d heel;
  };
  std::array<LegPoints, core::kLegs> legs;
};

[[nodiscard]] StickFigure stick_figure(const model::RobotParameters& robot,
                                       const core::RobotState& state);

}  // namespace hopscotch::apps
