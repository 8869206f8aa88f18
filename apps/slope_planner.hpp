#pragma once

#include <memory>

#include "control/ground_tilt.hpp"
#include "core/result.hpp"
#include "model/robot_parameters.hpp"
#include "planner/jump_planner.hpp"
#include "planner/known_jump.hpp"

namespace hopscotch::apps {

/// Largest horizontal force per vertical one with which soles on a slope still hold [-].
/// @param friction Of soles on the ground [-]. @param rise Of the ground towards where the force on
/// the robot points, @param across to its side: tangents [-].
/// @return 0 where soles slide even under the weight alone.
[[nodiscard]] double level_friction(double friction, double rise, double across);

/// Plans jumps from, onto and off slopes. Plans take the ground under the soles to be level; what
/// it holds less where a push-off goes uphill or a landing downhill, the planner is told as less
/// friction.
class SlopePlanner {
 public:
  /// @throws As planner::JumpPlanner.
  SlopePlanner(const planner::PlannerConfig& config, const model::RobotParameters& robot,
               std::shared_ptr<const planner::JumpLibrary> library);

  /// As planner::JumpPlanner::plan().
  core::Result<core::JumpPlan> plan(const planner::PlanRequest& request);

  /// Of the last plan, for plans of its rest; null on slopes, where those would slide, and if it
  /// was not solved.
  [[nodiscard]] std::shared_ptr<const planner::KnownJump> solution() const;

  /// The friction that a plan to a target may count on, as if the ground were level [-].
  [[nodiscard]] double friction_for(const core::LandingTarget& target) const;

 private:
  planner::PlannerConfig config_;
  model::RobotParameters robot_;
  std::shared_ptr<const planner::JumpLibrary> library_;
  planner::JumpPlanner level_;
  bool solved_ = false;  ///< By `level_`, the last plan.
};

}  // namespace hopscotch::apps
