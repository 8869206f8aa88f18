#include "apps/run_result.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/text_file.hpp"

namespace hopscotch::apps {

namespace {

using Json = nlohmann::ordered_json;

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

double number_from(const Json& object, const char* key) {
  const Json& value = object.at(key);
  return value.is_null() ? core::kNaN : value.get<double>();
}

/// NaN too in folders of programs that did not write it yet.
double later_number_from(const Json& object, const char* key) {
  return object.contains(key) ? number_from(object, key) : core::kNaN;
}

/// The value whose name stands under `key`.
template <typename Values, typename Name>
auto named_from(const Json& object, const char* key, const Values& values, Name name) {
  const auto text = object.at(key).get<std::string>();
  const auto found =
      std::find_if(values.begin(), values.end(), [&](auto value) { return name(value) == text; });
  if (found == values.end()) {
    throw std::runtime_error(std::string(key) + " = \"" + text + "\" is none of the known words");
  }
  return *found;
}

Percentiles percentiles_from(const Json& object, const char* key) {
  const Json& p = object.at(key);
  return {number_from(p, "p50"), number_from(p, "p99"), number_from(p, "max")};
}

RunTiming timing_from(const Json& json) {
  RunTiming timing;
  timing.plan_ms = percentiles_from(json, "plan_ms");
  timing.mpc_ms = percentiles_from(json, "mpc_ms");
  timing.perception_ms = percentiles_from(json, "perception_ms");
  timing.estimator_ms = percentiles_from(json, "estimator_ms");
  timing.tick_ms = percentiles_from(json, "tick_ms");
  timing.deadline_misses = json.at("deadline_misses").get<int>();
  timing.real_time_factor = number_from(json, "real_time_factor");
  return timing;
}

JumpResult::Plan plan_from(const Json& json) {
  JumpResult::Plan plan;
  plan.status = named_from(json, "status", kPlanStatuses, core::plan_status_name);
  plan.iterations = json.at("iterations").get<int>();
  plan.warm = json.at("warm").get<bool>();
  plan.duration = number_from(json, "duration_s");
  plan.binding_name = json.at("binding").at("name").get<std::string>();
  plan.binding_margin = number_from(json.at("binding"), "margin");
  return plan;
}

JumpResult jump_from(const Json& json) {
  JumpResult jump;
  jump.index = json.at("index").get<int>();
  jump.outcome = named_from(json, "outcome", kJumpOutcomes, jump_outcome_name);
  jump.reason = json.at("reason").get<std::string>();
  jump.start = later_number_from(json, "start_s");
  const Json& target = json.at("target");
  jump.target = {number_from(target, "distance_m"), number_from(target, "height_m"),
                 named_from(target, "source", kTargetSources, core::target_source_name)};
  const Json& landing = json.at("landing");
  jump.landing = {number_from(landing, "distance_m"), number_from(landing, "height_m"),
                  number_from(landing, "toe_margin_m"), number_from(landing, "heel_margin_m"),
                  later_number_from(landing, "pitch_error_rad")};
  jump.plan = plan_from(json.at("plan"));
  const Json& takeoff = json.at("takeoff");
  jump.takeoff = {number_from(takeoff, "speed_x_mps"), number_from(takeoff, "speed_z_mps"),
                  number_from(takeoff, "estimate_error_mps")};
  jump.flight = number_from(json, "flight_s");
  const Json& peak = json.at("peak");
  jump.peak = {number_from(peak, "torque_ratio"), number_from(peak, "speed_ratio"),
               number_from(peak, "power_ratio"), number_from(peak, "normal_force_N")};
  return jump;
}

RunResult run_from(const Json& json) {
  const auto schema = json.at("schema").get<std::string>();
  if (schema != RunResult::kSchema) throw std::runtime_error("schema is \"" + schema + "\"");
  RunResult result;
  result.run_id = json.at("run_id").get<std::string>();
  result.scenario = json.at("scenario").get<std::string>();
  result.seed = json.at("seed").get<std::uint64_t>();
  result.program = json.at("program").get<std::string>();
  result.perception = json.at("perception").get<std::string>();
  result.state = json.at("state").get<std::string>();
  result.outcome = named_from(json, "outcome", kRunOutcomes, run_outcome_name);
  result.reason = json.at("reason").get<std::string>();
  result.duration = number_from(json, "duration_s");
  for (const Json& jump : json.at("jumps")) result.jumps.push_back(jump_from(jump));
  result.falls = json.at("falls").get<int>();
  result.position_error = number_from(json.at("state_error"), "position_m");
  result.pitch_error = number_from(json.at("state_error"), "pitch_rad");
  result.timing = timing_from(json.at("timing"));
  return result;
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
  try {
    return run_from(Json::parse(text));
  } catch (const std::exception& error) {
    throw std::runtime_error(name + ": " + error.what());
  }
}

void write_run_result(const std::filesystem::path& file, const RunResult& result) {
  write_file_atomically(file, to_json(result));
}

RunResult read_run_result(const std::filesystem::path& file) {
  return run_result_from_json(read_file(file), file.string());
}

}  // namespace hopscotch::apps
