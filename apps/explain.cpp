#include "apps/explain.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/evidence.hpp"
#include "core/reason.hpp"

namespace hopscotch::apps {

using core::Reason;

std::string_view cause_code(Cause cause) {
  switch (cause) {
    case Cause::none: return "none";
    case Cause::push: return "push";
    case Cause::slip: return "slip";
    case Cause::toe_catch: return "toe_catch";
    case Cause::terrain_height: return "terrain_height";
    case Cause::overshoot: return "overshoot";
    case Cause::undershoot: return "undershoot";
    case Cause::sideways: return "sideways";
    case Cause::takeoff_speed: return "takeoff_speed";
    case Cause::saturation: return "saturation";
    case Cause::estimator: return "estimator";
    case Cause::contact: return "contact";
    case Cause::late_plan: return "late_plan";
    case Cause::deadline: return "deadline";
    case Cause::sensors: return "sensors";
    case Cause::joint_limit: return "joint_limit";
    case Cause::tilt: return "tilt";
    case Cause::no_target: return "no_target";
    case Cause::plan_infeasible: return "plan_infeasible";
    case Cause::operator_stop: return "operator_stop";
    case Cause::unknown: return "unknown";
  }
  return "unknown";
}

namespace {

/// Code of "code: sentence".
Reason reason_of(const std::string& text) {
  const std::string code = text.substr(0, text.find(':'));
  for (int i = 1; i <= static_cast<int>(Reason::internal_error); ++i) {
    if (core::reason_code(static_cast<Reason>(i)) == code) return static_cast<Reason>(i);
  }
  return Reason::none;
}

/// What a reason that the program gave itself says about the first cause; none: the log must tell.
std::optional<Cause> cause_of(Reason reason) {
  switch (reason) {
    case Reason::plan_late: return Cause::late_plan;
    case Reason::plan_infeasible:
    case Reason::certificate_refused: return Cause::plan_infeasible;
    case Reason::stale_sensors:
    case Reason::bad_sensor_value: return Cause::sensors;
    case Reason::deadline: return Cause::deadline;
    case Reason::stopped_by_user:
    case Reason::jump_count_reached:
    case Reason::time_limit: return Cause::operator_stop;
    default: return std::nullopt;
  }
}

Clue at_the_end(const Evidence& evidence, Cause cause, std::string sentence) {
  Clue finding{.cause = cause, .unit = "", .sentence = std::move(sentence)};
  finding.time = evidence.result.duration;
  finding.jump = static_cast<int>(evidence.result.jumps.size());
  return finding;
}

/// The last decision: why each place that was looked at would not do.
std::string rejections(const Evidence& evidence) {
  if (!evidence.choice) return "";
  std::vector<std::pair<std::string_view, int>> counts;
  for (std::size_t i = 0; i < evidence.choice->rejected_count; ++i) {
    const std::string_view why = core::reason_code(evidence.choice->rejected[i].why);
    const auto known = std::find_if(counts.begin(), counts.end(),
                                    [&](const auto& count) { return count.first == why; });
    if (known == counts.end()) {
      counts.emplace_back(why, 1);
    } else {
      ++known->second;
    }
  }
  std::string text;
  for (const auto& [why, count] : counts) {
    text += (text.empty() ? "; rejected places: " : ", ") + std::string(why) + " " +
            std::to_string(count);
  }
  return text;
}

/// The cause by what the program said itself, where no evidence from the motion is needed.
Clue stated_cause(const Evidence& evidence) {
  const RunResult& result = evidence.result;
  const Reason reason = reason_of(result.reason);
  if (const std::optional<Cause> cause = cause_of(reason)) {
    return at_the_end(evidence, *cause, result.reason);
  }
  if (result.outcome == RunOutcome::refused) {
    return at_the_end(evidence, Cause::no_target, result.reason + rejections(evidence));
  }
  if (reason == Reason::joint_limit) return at_the_end(evidence, Cause::joint_limit, result.reason);
  return at_the_end(evidence, Cause::unknown, result.reason);
}

bool went_well(const RunResult& result) {
  const bool landed = std::all_of(result.jumps.begin(), result.jumps.end(), [](const auto& jump) {
    return jump.outcome == JumpOutcome::landed;
  });
  return result.outcome == RunOutcome::completed && landed;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(std::round(value * 1e6) / 1e6)
                              : nlohmann::ordered_json();
}

nlohmann::ordered_json json_of(const Clue& finding) {
  return {
      {"code", cause_code(finding.cause)}, {"time_s", number(finding.time)}, {"jump", finding.jump},
      {"value", number(finding.value)},    {"limit", number(finding.limit)}, {"unit", finding.unit},
      {"sentence", finding.sentence}};
}

}  // namespace

Explanation explain_run(const RunFolder& folder) {
  const Evidence evidence = collect_evidence(folder);
  Explanation explanation{.result = evidence.result, .first = {}, .findings = {}};
  if (went_well(evidence.result)) {
    explanation.first =
        at_the_end(evidence, Cause::none, "the run was completed, nothing to explain");
    return explanation;
  }
  explanation.first = stated_cause(evidence);
  const bool standing = evidence.result.outcome == RunOutcome::refused ||
                        explanation.first.cause == Cause::operator_stop;
  if (standing) {
    explanation.findings.push_back(explanation.first);
    return explanation;
  }
  for (const Detector detect : detectors()) {
    if (std::optional<Clue> finding = detect(evidence)) explanation.findings.push_back(*finding);
  }
  std::stable_sort(explanation.findings.begin(), explanation.findings.end(),
                   [](const Clue& a, const Clue& b) { return a.time < b.time; });
  const bool stated = explanation.first.cause != Cause::unknown;
  if (!stated && !explanation.findings.empty()) {
    // Leaning over is what a fall looks like: a cause only where there is no other.
    const auto first = std::find_if(explanation.findings.begin(), explanation.findings.end(),
                                    [](const Clue& f) { return f.cause != Cause::tilt; });
    const bool other = first != explanation.findings.end();
    explanation.first = other ? *first : explanation.findings.front();
  }
  if (stated) explanation.findings.push_back(explanation.first);
  return explanation;
}

std::string to_text(const Explanation& explanation) {
  const RunResult& result = explanation.result;
  std::string text = result.scenario + ", seed " + std::to_string(result.seed) + ": " +
                     std::string(run_outcome_name(result.outcome)) +
                     (result.reason.empty() ? "" : ", " + result.reason) + "\n";
  const auto line = [](const Clue& finding) {
    char head[64];
    std::snprintf(head, sizeof head, "%7.2f s  jump %-3d ", finding.time, finding.jump);
    std::string code(cause_code(finding.cause));
    code.resize(std::max<std::size_t>(code.size() + 1, 16), ' ');
    return head + code + finding.sentence + "\n";
  };
  text += "first cause: " + std::string(cause_code(explanation.first.cause)) + "\n" +
          line(explanation.first);
  if (explanation.findings.size() > 1) {
    text += "all evidence of the last jump, in order of time:\n";
    for (const Clue& finding : explanation.findings) text += line(finding);
  }
  return text;
}

std::string to_json(const Explanation& explanation) {
  const RunResult& result = explanation.result;
  nlohmann::ordered_json json = {{"schema", "hopscotch.explain/1"},
                                 {"run_id", result.run_id},
                                 {"scenario", result.scenario},
                                 {"seed", result.seed},
                                 {"outcome", run_outcome_name(result.outcome)},
                                 {"reason", result.reason},
                                 {"first_cause", json_of(explanation.first)},
                                 {"findings", nlohmann::ordered_json::array()}};
  for (const Clue& finding : explanation.findings) json["findings"].push_back(json_of(finding));
  return json.dump(2) + "\n";
}

}  // namespace hopscotch::apps
