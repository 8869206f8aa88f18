#include "apps/plan_json.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "core/landing_target.hpp"

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

Json summary(const core::JumpPlan& plan, const PlanContext& context) {
  const core::JumpKnot& liftoff = first_flight_knot(plan);
  Json json;
  json["schema"] = "hopscotch.plan/1";
  json["status"] = core::plan_status_name(plan.status);
  json["distance_m"] = plan.target.distance;
  json["height_m"] = plan.target.height;
  json["model"] = context.model;
  json["solver"] = context.solver;
  json["solve_ms"] = {{"p50", context.solve_ms.p50},
                      {"p99", context.solve_ms.p99},
                      {"max", context.solve_ms.max},
                      {"n", context.solves}};
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
  json["max_violation"] = plan.certificate.max_violation;
  json["dense_max_violation"] = plan.certificate.dense_max_violation;
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

std::string plan_trajectory_json(const core::JumpPlan& plan, const PlanContext& context) {
  Json json = summary(plan, context);
  json["knots"] = Json::array();
  for (std::size_t i = 0; i < plan.knot_count; ++i)
    json["knots"].push_back(knot_json(plan.knots[i]));
  return json.dump(1) + "\n";
}

}  // namespace hopscotch::apps
