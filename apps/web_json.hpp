#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/one_step_terrain.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "msgs/messages.hpp"

/// What the page is told, as compact JSON. Lengths in metres, rounded to 0.1 mm; NaN becomes null.
namespace hopscotch::apps {

/// Longest computing time of each stage since the last frame.
struct WebWork {
  msgs::StageTimes longest;
  void include(const msgs::StageTimes& times);
};

/// Where a decision was made from: frame S.
struct WebStance {
  Eigen::Vector3d p_WS = Eigen::Vector3d::Constant(core::kNaN);  ///< [m]
  double heading = core::kNaN;                                   ///< Yaw of S in W [rad].
};

/// What is known at one moment.
struct WebMoment {
  core::RobotState shown;     ///< Drawn: the plant's truth in simulation, else as believed.
  core::RobotState believed;  ///< By the controller.
  core::ContactWrenches ground{};
  core::JointVector tau = core::JointVector::Constant(core::kNaN);
  msgs::Status status;
  WebWork work;
  WebStance stance;
};

[[nodiscard]] std::string quoted_json(std::string_view text);
/// Names of the numbers in `frame_json`, in order.
[[nodiscard]] std::string frame_columns_json();
[[nodiscard]] std::string frame_json(const WebMoment& moment, const model::RobotParameters& robot);
[[nodiscard]] std::string robot_json(const model::RobotParameters& robot);
[[nodiscard]] std::string scene_json(const msgs::Scene& scene);
[[nodiscard]] std::string terrain_json(core::Stamp now, const core::OneStepTerrain& terrain);
[[nodiscard]] std::string choice_json(core::Stamp now, const core::TargetChoice& choice,
                                      const WebStance& stance);
[[nodiscard]] std::string plan_json(core::Stamp now, const core::JumpPlan& plan);
[[nodiscard]] std::string map_json(core::Stamp now, const msgs::MapView& map);
[[nodiscard]] std::string ack_json(core::Stamp now, const msgs::Ack& ack);

}  // namespace hopscotch::apps
