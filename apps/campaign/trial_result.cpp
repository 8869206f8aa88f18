#include "apps/campaign/trial_result.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace hopscotch::apps::campaign {

using Json = nlohmann::ordered_json;

namespace {

/// Largest of those that are numbers.
void raise(double& kept, double value) {
  if (!std::isnan(value) && !(kept >= value)) kept = value;
}
void lower(double& kept, double value) {
  if (!std::isnan(value) && !(kept <= value)) kept = value;
}

Cause split(const std::string& reason) {
  const std::size_t colon = reason.find(": ");
  if (colon == std::string::npos) return {reason, ""};
  return {reason.substr(0, colon), reason.substr(colon + 2)};
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

double number_from(const Json& value) {
  return value.is_null() ? core::kNaN : value.get<double>();
}

void include_jump(const JumpResult& jump, TrialResult& result) {
  if (jump.outcome == JumpOutcome::landed) ++result.landed;
  result.target_distance = jump.target.distance;
  if (!std::isnan(jump.landing.distance)) result.distance = jump.landing.distance;
  raise(result.landing_error, std::abs(jump.landing.distance - jump.target.distance));
  lower(result.support_margin, jump.landing.toe_margin);
  lower(result.support_margin, jump.landing.heel_margin);
  raise(result.torque_ratio, jump.peak.torque_ratio);
  raise(result.speed_ratio, jump.peak.speed_ratio);
  raise(result.power_ratio, jump.peak.power_ratio);
  raise(result.normal_force, jump.peak.normal_force);
  raise(result.estimate_error, jump.takeoff.estimate_error);
  raise(result.pitch_error, jump.landing.pitch_error);
  result.takeoff_x = jump.takeoff.speed_x;
  result.takeoff_z = jump.takeoff.speed_z;
}

}  // namespace

bool TrialResult::succeeded() const {
  return outcome == "completed" || (outcome == "refused" && truth_outcome == "refused");
}

Cause first_cause(const RunResult& run) {
  for (const JumpResult& jump : run.jumps) {
    const bool bad = jump.outcome == JumpOutcome::missed || jump.outcome == JumpOutcome::fell;
    if (bad && !jump.reason.empty()) return split(jump.reason);
  }
  return split(run.reason);
}

void include_run(const RunResult& run, TrialResult& result) {
  result.outcome = run_outcome_name(run.outcome);
  const Cause cause = first_cause(run);
  result.cause = cause.code;
  result.sentence = cause.sentence;
  result.jumps = static_cast<int>(run.jumps.size());
  result.duration = run.duration;
  for (const JumpResult& jump : run.jumps) include_jump(jump, result);
  const JumpTimes times = jump_times(run.jumps);
  result.jump_time = times.mean;
  result.jump_time_p95 = times.p95;
}

std::string to_line(const TrialResult& result) {
  Json json{{"trial", result.index},     {"seed", result.seed},
            {"outcome", result.outcome}, {"truth_outcome", result.truth_outcome},
            {"cause", result.cause},     {"sentence", result.sentence},
            {"jumps", result.jumps},     {"landed", result.landed}};
  for (const Metric& metric : kMetrics) {
    json[std::string(metric.name)] = number(result.*metric.value);
  }
  json["wall_s"] = number(result.wall);
  Json values = Json::array();
  for (const double value : result.values) values.push_back(number(value));
  json["values"] = std::move(values);
  Json path = Json::array();  // x and z in turn
  for (const auto& [x, z] : result.path) {
    path.push_back(x);
    path.push_back(z);
  }
  json["path"] = std::move(path);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

TrialResult result_from_line(std::string_view line) {
  try {
    const Json json = Json::parse(line);
    TrialResult result;
    result.index = json.at("trial").get<std::int64_t>();
    result.seed = json.at("seed").get<std::uint64_t>();
    result.outcome = json.at("outcome").get<std::string>();
    result.truth_outcome = json.at("truth_outcome").get<std::string>();
    result.cause = json.at("cause").get<std::string>();
    result.sentence = json.at("sentence").get<std::string>();
    result.jumps = json.at("jumps").get<int>();
    result.landed = json.at("landed").get<int>();
    for (const Metric& metric : kMetrics) {
      result.*metric.value = number_from(json.at(std::string(metric.name)));
    }
    result.wall = number_from(json.at("wall_s"));
    for (const Json& value : json.at("values")) result.values.push_back(number_from(value));
    const Json& path = json.at("path");
    for (std::size_t i = 0; i + 1 < path.size(); i += 2) {
      result.path.push_back({path[i].get<std::int16_t>(), path[i + 1].get<std::int16_t>()});
    }
    return result;
  } catch (const Json::exception& error) {
    throw std::runtime_error(std::string("not the result of a trial: ") + error.what());
  }
}

}  // namespace hopscotch::apps::campaign
