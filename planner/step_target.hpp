#pragma once

#include "core/landing_target.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "model/stand_posture.hpp"

namespace hopscotch::planner {

/// A jump from level ground onto level ground of another height, as `hopscotch plan` asks for it.
struct StepRequest {
  double distance = core::kNaN;  ///< Sole centre to sole centre [m].
  double height = 0.0;           ///< Of the ground behind the edge [m].
  double edge = core::kNaN;      ///< Where the ground changes height, from the start [m].
  double lateral = 0.0;          ///< Of the target, to the left [m].
  double yaw = 0.0;              ///< Of the target soles [rad].
};

/// Where the ground changes height when nothing is said: close ahead for a jump down, short of the
/// landing sole for a jump up [m].
[[nodiscard]] double default_edge(double distance, double height);

/// The landing target of such a jump for a robot that stands at the origin of W, S = W.
[[nodiscard]] core::LandingTarget step_target(const StepRequest& request,
                                              const model::RobotParameters& robot);

/// The robot standing in `pose` with the mid-point of its soles at the origin of W, at rest.
[[nodiscard]] core::RobotState standing_state(const model::StandPose& pose);

}  // namespace hopscotch::planner
