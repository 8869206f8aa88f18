#include "apps/run_result.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/json_fields.hpp"
#include "apps/text_file.hpp"

namespace hopscotch::apps {

namespace {

using Json = JsonFields::Json;

constexpr std::array<RunOutcome, 5> kRunOutcomes{RunOutcome::completed, RunOutcome::refused,
                                                 RunOutcome::fell, RunOutcome::fault,
                                                 RunOutcome::stopped};
constexpr std::array<JumpOutcome, 4> kJumpOutcomes{JumpOutcome::landed, JumpOutcome::fell,
                                                   JumpOutcome::missed, JumpOutcome::aborted};
constexpr std::array<core::PlanStatus, 4> kPlanStatuses{
    core::PlanStatus::solved, core::PlanStatus::iteration_limit, core::PlanStatus::infeasible,
    core::PlanStatus::bad_input};
constexpr std::array<core::TargetSource, 3> kTargetSources{core::TargetSource::perception,
                                                           core::TargetSource::truth,
                                                           core::TargetSource::operator_override};

/// Six decimals: below any physical meaning here, and the text stays short.
Json number(double value) {
  constexpr double kDecimals = 1e6;
  if (!std::isfinite(value)) return nullptr;
  const double rounded = std::round(value * kDecimals) / kDecimals;
  return rounded == 0.0 ? 0.0 : rounded;  // no "-0.0"
}

Json percentiles_json(const Percentiles& p) {
  return {{"p50", number(p.p50)}, {"p99", number(p.p99)}, {"max", number(p.max)}};
}

Json timing_json(const RunTiming& timing) {
  return {{"plan_ms", percentiles_json(timing.plan_ms)},
          {"replan_ms", percentiles_json(timing.replan_ms)},
          {"mpc_ms", percentiles_json(timing.mpc_ms)},
          {"perception_ms", percentiles_json(timing.perception_ms)},
          {"estimator_ms", percentiles_json(timing.estimator_ms)},
          {"tick_ms", percentiles_json(timing.tick_ms)},
          {"deadline_misses", timing.deadline_misses},
          {"real_time_factor", number(timing.real_time_factor)}};
}

Json plan_json(const JumpResult::Plan& plan) {
  return {{"status", core::plan_status_name(plan.status)},
          {"iterations", plan.iterations},
          {"warm", plan.warm},
          {"replanned", plan.replanned},
          {"duration_s", number(plan.duration)},
          {"binding", {{"name", plan.binding_name}, {"margin", number(plan.binding_margin)}}}};
}

Json jump_json(const JumpResult& jump) {
  return {{"index", jump.index},
          {"outcome", jump_outcome_name(jump.outcome)},
          {"reason", jump.reason},
          {"start_s", number(jump.start)},
          {"target",
           {{"distance_m", number(jump.target.distance)},
            {"height_m", number(jump.target.height)},
            {"source", core::target_source_name(jump.target.source)}}},
          {"landing",
           {{"distance_m", number(jump.landing.distance)},
            {"height_m", number(jump.landing.height)},
            {"toe_margin_m", number(jump.landing.toe_margin)},
            {"heel_margin_m", number(jump.landing.heel_margin)},
            {"pitch_error_rad", number(jump.landing.pitch_error)}}},
          {"plan", plan_json(jump.plan)},
          {"takeoff",
           {{"speed_x_mps", number(jump.takeoff.speed_x)},
            {"speed_z_mps", number(jump.takeoff.speed_z)},
            {"estimate_error_mps", number(jump.takeoff.estimate_error)}}},
          {"flight_s", number(jump.flight)},
          {"peak",
           {{"torque_ratio", number(jump.peak.torque_ratio)},
            {"speed_ratio", number(jump.peak.speed_ratio)},
            {"power_ratio", number(jump.peak.power_ratio)},
            {"normal_force_N", number(jump.peak.normal_force)}}}};
}

Json times_json(const JumpTimes& times) {
  return {{"mean", number(times.mean)}, {"p95", number(times.p95)}, {"n", times.count}};
}

Json run_json(const RunResult& result) {
  Json jumps = Json::array();
  for (const JumpResult& jump : result.jumps) jumps.push_back(jump_json(jump));
  return {
      {"schema", RunResult::kSchema},
      {"run_id", result.run_id},
      {"scenario", result.scenario},
      {"seed", result.seed},
      {"program", result.program},
      {"perception", result.perception},
      {"state", result.state},
      {"outcome", run_outcome_name(result.outcome)},
      {"reason", result.reason},
      {"duration_s", number(result.duration)},
      {"jumps", std::move(jumps)},
      {"jump_time_s", times_json(jump_times(result.jumps))},
      {"falls", result.falls},
      {"state_error",
       {{"position_m", number(result.position_error)}, {"pitch_rad", number(result.pitch_error)}}},
      {"timing", timing_json(result.timing)}};
}

/// NaN too in folders of programs that did not write it yet.
double later_number(const JsonFields& object, const char* key) {
  return object.has(key) ? object.number(key) : core::kNaN;
}

/// The value whose name stands under `key`.
template <typename Values, typename Name>
auto named(const JsonFields& object, const char* key, const Values& values, Name name) {
  const std::string text = object.text(key);
  const auto found =
      std::find_if(values.begin(), values.end(), [&](auto value) { return name(value) == text; });
  if (found == values.end()) object.reject(key, "is none of the known words");
  return *found;
}

Percentiles percentiles_from(const JsonFields& p) {
  return {p.number("p50"), p.number("p99"), p.number("max")};
}

RunTiming timing_from(const JsonFields& json) {
  RunTiming timing;
  timing.plan_ms = percentiles_from(json.object("plan_ms"));
  if (json.has("replan_ms")) timing.replan_ms = percentiles_from(json.object("replan_ms"));
  timing.mpc_ms = percentiles_from(json.object("mpc_ms"));
  timing.perception_ms = percentiles_from(json.object("perception_ms"));
  timing.estimator_ms = percentiles_from(json.object("estimator_ms"));
  timing.tick_ms = percentiles_from(json.object("tick_ms"));
  timing.deadline_misses = json.count("deadline_misses");
  timing.real_time_factor = json.number("real_time_factor");
  return timing;
}

JumpResult::Plan plan_from(const JsonFields& json) {
  JumpResult::Plan plan;
  plan.status = named(json, "status", kPlanStatuses, core::plan_status_name);
  plan.iterations = json.count("iterations");
  plan.warm = json.flag("warm");
  if (json.has("replanned")) plan.replanned = json.count("replanned");
  plan.duration = json.number("duration_s");
  const JsonFields binding = json.object("binding");
  plan.binding_name = binding.text("name");
  plan.binding_margin = binding.number("margin");
  return plan;
}

JumpResult jump_from(const JsonFields& json) {
  JumpResult jump;
  jump.index = json.count("index");
  jump.outcome = named(json, "outcome", kJumpOutcomes, jump_outcome_name);
  jump.reason = json.text("reason");
  jump.start = later_number(json, "start_s");
  const JsonFields target = json.object("target");
  jump.target = {target.number("distance_m"), target.number("height_m"),
                 named(target, "source", kTargetSources, core::target_source_name)};
  const JsonFields landing = json.object("landing");
  jump.landing = {landing.number("distance_m"), landing.number("height_m"),
                  landing.number("toe_margin_m"), landing.number("heel_margin_m"),
                  later_number(landing, "pitch_error_rad")};
  jump.plan = plan_from(json.object("plan"));
  const JsonFields takeoff = json.object("takeoff");
  jump.takeoff = {takeoff.number("speed_x_mps"), takeoff.number("speed_z_mps"),
                  takeoff.number("estimate_error_mps")};
  jump.flight = json.number("flight_s");
  const JsonFields peak = json.object("peak");
  jump.peak = {peak.number("torque_ratio"), peak.number("speed_ratio"), peak.number("power_ratio"),
               peak.number("normal_force_N")};
  return jump;
}

}  // namespace

std::string_view run_outcome_name(RunOutcome outcome) {
  switch (outcome) {
    case RunOutcome::completed: return "completed";
    case RunOutcome::refused: return "refused";
    case RunOutcome::fell: return "fell";
    case RunOutcome::fault: return "fault";
    case RunOutcome::stopped: return "stopped";
  }
  return "stopped";
}

std::string_view jump_outcome_name(JumpOutcome outcome) {
  switch (outcome) {
    case JumpOutcome::landed: return "landed";
    case JumpOutcome::fell: return "fell";
    case JumpOutcome::missed: return "missed";
    case JumpOutcome::aborted: return "aborted";
  }
  return "aborted";
}

Percentiles Percentiles::of(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  const auto rank = [&](double share) {
    const auto n = static_cast<double>(samples.size());
    return samples[static_cast<std::size_t>(std::max(std::ceil(share * n) - 1.0, 0.0))];
  };
  return {rank(0.50), rank(0.99), samples.back()};
}

JumpTimes jump_times(const std::vector<JumpResult>& jumps) {
  constexpr double kShare = 0.95;
  std::vector<double> times;
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < jumps.size(); ++i) {
    const double time = jumps[i + 1].start - jumps[i].start;
    if (jumps[i].outcome != JumpOutcome::landed || std::isnan(time)) continue;
    times.push_back(time);
    sum += time;
  }
  if (times.empty()) return {};
  std::sort(times.begin(), times.end());
  const auto n = static_cast<double>(times.size());
  return {sum / n, times[static_cast<std::size_t>(std::ceil(kShare * n)) - 1],
          static_cast<int>(times.size())};
}

std::string to_json(const RunResult& result) {
  constexpr int kIndent = 2;
  // Text from outside (names, reasons) may hold any bytes; a result must never fail for that.
  return run_json(result).dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunResult run_result_from_json(std::string_view text, const std::string& name) {
  const JsonFields json = JsonFields::parse(text, name);
  if (json.text("schema") != RunResult::kSchema) {
    json.reject("schema", "must be " + std::string(RunResult::kSchema));
  }
  RunResult result;
  result.run_id = json.text("run_id");
  result.scenario = json.text("scenario");
  result.seed = json.seed("seed");
  result.program = json.text("program");
  result.perception = json.text("perception");
  result.state = json.text("state");
  result.outcome = named(json, "outcome", kRunOutcomes, run_outcome_name);
  result.reason = json.text("reason");
  result.duration = json.number("duration_s");
  for (const JsonFields& jump : json.list("jumps")) result.jumps.push_back(jump_from(jump));
  result.falls = json.count("falls");
  result.position_error = json.object("state_error").number("position_m");
  result.pitch_error = json.object("state_error").number("pitch_rad");
  result.timing = timing_from(json.object("timing"));
  return result;
}

void write_run_result(const std::filesystem::path& file, const RunResult& result) {
  write_file_atomically(file, to_json(result));
}

RunResult read_run_result(const std::filesystem::path& file) {
  return run_result_from_json(read_file(file), file.string());
}

}  // namespace hopscotch::apps
