#include "apps/plan_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/landing_target.hpp"
#include "planner/certified_plan.hpp"
#include "planner/lift_to_3d.hpp"

namespace hopscotch::apps {

namespace {

using Json = nlohmann::ordered_json;

template <typename Vector>
Json list(const Vector& values) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) json.push_back(values[i]);
  return json;
}

const core::JumpKnot& first_flight_knot(const core::JumpPlan& plan) {
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    if (plan.knots[i].phase == core::JumpPhase::flight) return plan.knots[i];
  }
  return plan.knots[0];
}

/// Places and angles that may be unknown.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json solver_json(const PlanContext& context, std::string_view status) {
  return {{"schema", "hopscotch.plan/1"},
          {"status", status},
          {"model", context.model},
          {"solver", context.solver},
          {"solve_ms",
           {{"p50", context.solve_ms.p50},
            {"p99", context.solve_ms.p99},
            {"max", context.solve_ms.max},
            {"n", context.solves}}}};
}

Json flown_json(const FlownJump& flown) {
  const JumpResult& jump = flown.jump;
  return {{"outcome", jump_outcome_name(jump.outcome)},
          {"reason", jump.reason},
          {"landing",
           {{"distance_m", number(jump.landing.distance)},
            {"lateral_m", number(flown.lateral)},
            {"height_m", number(jump.landing.height)},
            {"yaw_rad", number(flown.yaw)}}},
          {"landing_error_m", number(flown.landing_error)},
          {"flight_s", number(jump.flight)},
          {"takeoff",
           {{"speed_x_mps", number(jump.takeoff.speed_x)},
            {"speed_z_mps", number(jump.takeoff.speed_z)}}},
          {"peak",
           {{"torque_ratio", number(jump.peak.torque_ratio)},
            {"speed_ratio", number(jump.peak.speed_ratio)},
            {"power_ratio", number(jump.peak.power_ratio)},
            {"normal_force_N", number(jump.peak.normal_force)}}}};
}

Json step_json(const planner::StepRequest& step) {
  return {{"distance_m", number(step.distance)},
          {"height_m", number(step.height)},
          {"edge_m", number(step.edge)},
          {"lateral_m", number(step.lateral)},
          {"yaw_rad", number(step.yaw)}};
}

Json summary(const core::JumpPlan& plan, const PlanContext& context) {
  const core::JumpKnot& liftoff = first_flight_knot(plan);
  Json json = solver_json(context, core::plan_status_name(plan.status));
  const planner::SideTarget side = planner::side_target(plan.target);
  json["distance_m"] = plan.target.distance;
  json["height_m"] = plan.target.height;
  json["lateral_m"] = side.lateral;
  json["yaw_rad"] = side.yaw;
  json["rung"] = context.rung;
  json["iterations"] = plan.iterations;
  json["duration_s"] = plan.duration;
  json["flight_s"] = plan.touchdown_time - plan.liftoff_time;
  json["takeoff"] = {{"speed_x_mps", liftoff.v_WG.x()}, {"speed_z_mps", liftoff.v_WG.z()}};
  json["peak"] = {{"torque_ratio", plan.peaks.torque_ratio},
                  {"speed_ratio", plan.peaks.speed_ratio},
                  {"power_ratio", plan.peaks.power_ratio},
                  {"normal_force_N", plan.peaks.normal_force}};
  json["certificate"] = Json::array();
  for (std::size_t i = 0; i < plan.certificate.count; ++i) {
    const core::CertificateEntry& entry = plan.certificate.entries[i];
    json["certificate"].push_back(
        {{"name", entry.name}, {"margin", entry.margin}, {"at_s", entry.time}});
  }
  json["certificate_holds"] = !planner::certificate_breach(plan.certificate);
  json["max_violation"] = plan.certificate.max_violation;
  json["dense_max_violation"] = plan.certificate.dense_max_violation;
  const core::CertificateEntry& binding = plan.certificate.binding();
  json["binding"] = {{"name", binding.name}, {"margin", binding.margin}};
  if (context.flown) json["flown"] = flown_json(*context.flown);
  return json;
}

Json knot_json(const core::JumpKnot& knot) {
  Json json;
  json["time_s"] = knot.time;
  json["dt_s"] = knot.dt;
  json["phase"] = core::jump_phase_name(knot.phase);
  json["p_WB_m"] = list(knot.p_WB);
  json["rpy_rad"] = list(knot.rpy);
  json["p_WG_m"] = list(knot.p_WG);
  json["v_WG_mps"] = list(knot.v_WG);
  json["q_rad"] = list(knot.q);
  json["dq_radps"] = list(knot.dq);
  json["tau_Nm"] = list(knot.tau);
  json["forces_N"] = {list(knot.wrenches[0].force), list(knot.wrenches[1].force)};
  json["moments_Nm"] = {list(knot.wrenches[0].moment), list(knot.wrenches[1].moment)};
  return json;
}

}  // namespace

std::string plan_summary_json(const core::JumpPlan& plan, const PlanContext& context) {
  return summary(plan, context).dump(2) + "\n";
}

std::string refused_plan_json(const RefusedPlan& refused, const PlanContext& context) {
  const bool malformed = refused.refusal.reason == core::Reason::target_malformed ||
                         refused.refusal.reason == core::Reason::bad_sensor_value;
  Json json =
      solver_json(context, core::plan_status_name(malformed ? core::PlanStatus::bad_input
                                                            : core::PlanStatus::infeasible));
  json.update(step_json(refused.step));
  json["reason"] = refused.refusal.text();
  json["iterations"] = refused.iterations;
  json["binding"] = refused.obstacle.empty() ? Json() : Json{{"name", refused.obstacle}};
  json["nearest_feasible"] = Json();
  if (refused.nearest) {
    const core::CertificateEntry& binding = refused.nearest->binding;
    json["nearest_feasible"] = step_json(refused.nearest->step);
    json["nearest_feasible"]["binding"] = {{"name", binding.name}, {"margin", binding.margin}};
  }
  return json.dump(2) + "\n";
}

std::string plan_trajectory_json(const core::JumpPlan& plan, const PlanContext& context) {
  Json json = summary(plan, context);
  json["knots"] = Json::array();
  for (std::size_t i = 0; i < plan.knot_count; ++i)
    json["knots"].push_back(knot_json(plan.knots[i]));
  return json.dump(1) + "\n";
}

}  // namespace hopscotch::apps
