#pragma once

#include <string>
#include <string_view>

#include "apps/run_result.hpp"
#include "core/jump_plan.hpp"

namespace hopscotch::apps {

/// What `hopscotch plan` says besides the plan itself.
struct PlanContext {
  std::string_view model;
  std::string_view solver;
  Percentiles solve_ms;
  int solves = 0;
};

/// Schema "hopscotch.plan/1": figures and certificate, one JSON object.
[[nodiscard]] std::string plan_summary_json(const core::JumpPlan& plan, const PlanContext& context);

/// The same with all knots, for `--out`.
[[nodiscard]] std::string plan_trajectory_json(const core::JumpPlan& plan,
                                               const PlanContext& context);

}  // namespace hopscotch::apps
