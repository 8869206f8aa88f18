#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

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

/// From which state a benchmark jumps.
enum class StartKind : std::uint8_t {
  stand,   ///< The stand posture at rest.
  low,     ///< CoM 4 cm lower.
  moving,  ///< The same, still sinking as after a landing.
};
[[nodiscard]] std::string_view start_kind_name(StartKind kind);
/// @return empty for any other text.
[[nodiscard]] std::optional<StartKind> start_kind_from(std::string_view name);
/// @return empty if the legs cannot take the posture.
[[nodiscard]] std::optional<core::RobotState> start_state(StartKind kind,
                                                          const model::RobotParameters& robot,
                                                          const model::StandPosture& posture);

}  // namespace hopscotch::planner
