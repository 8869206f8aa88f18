#pragma once

#include <optional>
#include <string_view>

#include "core/jump_plan.hpp"
#include "core/result.hpp"
#include "planner/corrected_solver.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// Joint motion re-integrated with the held torques may miss by so much, see `certify`.
inline constexpr double kDenseViolationMax = 1e-3;

/// By what a certificate does not hold: its worst limit or, where all limits are kept, the
/// dynamics. Nothing if it holds. @pre certificate.count > 0
[[nodiscard]] std::optional<core::Refusal> certificate_breach(const core::Certificate& certificate);

/// That no motion was found, after how much work.
/// @param limit What stood in the way, in the words of the certificate; empty if unknown.
[[nodiscard]] core::Refusal infeasible(const SolveOutcome& outcome, const PlanarTask& task,
                                       std::string_view limit);

/// Fills certificate, peaks and knots of a plan whose target is set.
/// @return why it is refused.
[[nodiscard]] std::optional<core::Refusal> certify_and_lift(const PlanarModel& model,
                                                            const PlanarTask& task,
                                                            const SolvedMotion& solved,
                                                            core::JumpPlan& plan);

}  // namespace hopscotch::planner
