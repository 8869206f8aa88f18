#pragma once

#include <functional>
#include <string>

#include "apps/program_config.hpp"
#include "apps/run_result.hpp"
#include "core/jump_plan.hpp"
#include "model/robot_parameters.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps {

/// One plan to be flown in MuJoCo, from a stand on the ground of `step`.
struct FlightTrial {
  core::JumpPlan plan;  ///< From standing at the origin.
  planner::StepRequest step;
  ProgramConfig config;
  model::RobotParameters robot;  ///< Simulated as it is modelled.
};

/// What became of it, by the plant's truth.
struct FlownJump {
  JumpResult jump;
  double lateral = core::kNaN;  ///< Of the soles' mid-point at rest, in S [m].
  double yaw = core::kNaN;      ///< Of the soles at rest, in S [rad].
  /// Horizontal distance of the soles' mid-point at rest from the target [m].
  double landing_error = core::kNaN;
};

/// Flies the plan with controller and MPC in lock-step, on the true state: what the plan promises
/// against what the physics of MuJoCo makes of it.
/// @throws core::ConfigError if the robot cannot stand as configured, or the ground of `step` is
/// none.
/// @param observe Sees the true state of each millisecond; may be empty.
[[nodiscard]] FlownJump fly(const FlightTrial& trial,
                            const std::function<void(const core::RobotState&)>& observe = {});

/// The world that `fly` simulates, as MuJoCo reads it. @throws as `fly`.
[[nodiscard]] std::string flight_scene(const FlightTrial& trial);

}  // namespace hopscotch::apps
