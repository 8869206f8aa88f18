#include "planner/certified_plan.hpp"

#include <cstdio>
#include <string>

#include "planner/certificate.hpp"
#include "planner/leg_certificate.hpp"
#include "planner/lift_to_3d.hpp"

namespace hopscotch::planner {

namespace {

using core::Reason;
using core::Refusal;

/// A margin below zero by less is rounding of the solver.
constexpr double kMarginTolerance = 1e-3;

}  // namespace

std::optional<Refusal> certificate_breach(const core::Certificate& certificate) {
  const core::CertificateEntry& worst = certificate.binding();
  char text[160];
  if (worst.margin < -kMarginTolerance) {
    std::snprintf(text, sizeof text, "%s has margin %.3f at %.3f s",
                  std::string(worst.name).c_str(), worst.margin, worst.time);
  } else if (certificate.dense_max_violation > kDenseViolationMax) {
    std::snprintf(text, sizeof text,
                  "integrated at 1 ms, the motion misses its knots by %.4f, allowed is %.4f",
                  certificate.dense_max_violation, kDenseViolationMax);
  } else {
    return std::nullopt;
  }
  return Refusal{Reason::certificate_refused, text};
}

Refusal infeasible(const SolveOutcome& outcome, const PlanarTask& task, std::string_view limit) {
  char text[200];
  std::snprintf(text, sizeof text,
                "no motion found to %.3f m, height %.3f m: %s after %d iterations, largest "
                "violation %.2g",
                task.distance, task.height,
                outcome.status == SolveStatus::iteration_limit ? "stopped" : "gave up",
                outcome.iterations, outcome.violation);
  const std::string by = limit.empty() ? "" : "; stopped by " + std::string(limit);
  return {Reason::plan_infeasible, text + by};
}

std::optional<Refusal> certify_and_lift(const PlanarModel& model, const PlanarTask& task,
                                        const SolvedMotion& solved, core::JumpPlan& plan) {
  const PlanarMotion& motion = solved.motion;
  const CertifiedMotion certified = certify(model, task, motion);
  plan.certificate = certified.certificate;
  plan.certificate.max_violation = solved.outcome.violation;
  plan.peaks = certified.peaks;
  if (auto breach = certificate_breach(plan.certificate)) return breach;
  if (!lift_to_3d(model, motion, plan.target, plan)) {
    return Refusal{Reason::out_of_reach, "a leg cannot reach so far to the side"};
  }
  if (!side_target(plan.target).is_straight()) {
    certify_legs(model.robot, model.config.friction, plan);
  }
  return certificate_breach(plan.certificate);
}

}  // namespace hopscotch::planner
