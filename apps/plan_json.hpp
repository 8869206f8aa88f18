#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "apps/flight_trial.hpp"
#include "apps/run_result.hpp"
#include "core/jump_plan.hpp"
#include "core/reason.hpp"
#include "planner/nearest_target.hpp"

namespace hopscotch::apps {

/// What `hopscotch plan` says besides the plan itself.
struct PlanContext {
  std::string_view model;
  std::string_view solver;
  std::string_view rung;  ///< Of the planner's ladder.
  Percentiles solve_ms;
  int solves = 0;
  std::optional<FlownJump> flown;  ///< Where the plan was flown.
};

/// A target without a plan.
struct RefusedPlan {
  planner::StepRequest step;
  core::Refusal refusal;
  std::string_view obstacle;  ///< Limit in the way; empty if the request was malformed.
  int iterations = 0;
  std::optional<planner::NearestTarget> nearest;
};

/// Schema "hopscotch.plan/1": figures and certificate, one JSON object.
[[nodiscard]] std::string plan_summary_json(const core::JumpPlan& plan, const PlanContext& context);

/// The same schema for a refusal: status, reason, binding limit and the nearest feasible target.
[[nodiscard]] std::string refused_plan_json(const RefusedPlan& refused, const PlanContext& context);

/// The first with all knots, for `--out`.
[[nodiscard]] std::string plan_trajectory_json(const core::JumpPlan& plan,
                                               const PlanContext& context);

}  // namespace hopscotch::apps
