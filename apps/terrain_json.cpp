#include "apps/terrain_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace hopscotch::apps {

namespace {

using Json = nlohmann::ordered_json;

const char* edge_name(core::EdgeKind kind) {
  switch (kind) {
    case core::EdgeKind::up: return "up";
    case core::EdgeKind::down: return "down";
    case core::EdgeKind::gap_near: return "gap_near";
    case core::EdgeKind::gap_far: return "gap_far";
  }
  return "up";
}

/// JSON has no NaN: a number that is not known is null. Tenths of a millimetre are enough.
Json number(double value) {
  constexpr double kDigits = 1e5;
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * kDigits) / kDigits;
}

Json ground_json(const TerrainReport& report) {
  const perception::SurveyedTread* ground = report.survey.ground();
  if (ground == nullptr) {
    return {{"height_m", nullptr}, {"slope_rad", nullptr}, {"roughness_m", nullptr}};
  }
  return {{"height_m", number(report.terrain.p_WS.z() + ground->height)},
          {"slope_rad", number(ground->slope)},
          {"roughness_m", number(ground->roughness)}};
}

void add_features(const perception::LineSurvey& survey, Json& json) {
  const core::OneStepTerrain& features = survey.features;
  Json edges = Json::array();
  Json steps = Json::array();
  for (std::size_t i = 0; i < features.edge_count; ++i) {
    const core::TerrainEdge& edge = features.edges[i];
    edges.push_back({{"x_m", number(edge.x)},
                     {"sigma_m", number(edge.sigma)},
                     {"kind", edge_name(edge.kind)},
                     {"step_m", number(edge.step)}});
    const bool counted = edge.kind != core::EdgeKind::gap_near && std::isfinite(edge.step);
    if (counted) {
      steps.push_back(
          {{"height_m", number(edge.step)}, {"sigma_m", number(survey.step_sigmas[i])}});
    }
  }
  Json gaps = Json::array();
  for (std::size_t i = 0; i < features.gap_count; ++i) {
    const core::TerrainGap& gap = features.gaps[i];
    gaps.push_back({{"near_m", number(gap.near_x)},
                    {"far_m", number(gap.far_x)},
                    {"width_m", number(gap.far_x - gap.near_x)},
                    {"sigma_m", number(gap.sigma)}});
  }
  json["edges"] = edges;
  json["gaps"] = gaps;
  json["steps"] = steps;
}

void add_targets(const core::TargetChoice& choice, Json& json) {
  Json targets = Json::array();
  for (std::size_t i = 0; i < choice.ranked_count; ++i) {
    const core::RankedTarget& target = choice.ranked[i];
    targets.push_back({{"distance_m", number(target.distance)},
                       {"height_m", number(target.height)},
                       {"safe_probability", number(target.safe_probability)},
                       {"tread_m", number(target.tread)}});
  }
  Json rejected = Json::array();
  for (std::size_t i = 0; i < choice.rejected_count; ++i) {
    const core::RejectedTarget& place = choice.rejected[i];
    rejected.push_back(
        {{"distance_m", number(place.distance)}, {"why", core::reason_code(place.why)}});
  }
  json["targets"] = targets;
  json["rejected"] = rejected;
  json["chosen_m"] = choice.target ? number(choice.target->distance) : Json(nullptr);
  json["refusal"] = choice.target ? "" : choice.refusal.text();
}

}  // namespace

std::string terrain_json(const TerrainReport& report) {
  Json json;
  json["schema"] = "hopscotch.terrain/1";
  json["stamp_s"] = report.stamp.seconds();
  json["status"] = report.status;
  json["ground"] = ground_json(report);
  add_features(report.survey, json);
  json["planes"] = Json::array();
  for (const ReportedPlane& plane : report.planes) {
    json["planes"].push_back({{"height_m", number(plane.height)},
                              {"slope_rad", number(plane.slope)},
                              {"points", plane.points}});
  }
  add_targets(report.choice, json);
  json["coverage"] = number(report.terrain.coverage);
  json["latency_ms"] = number(report.latency_ms);
  return json.dump();
}

}  // namespace hopscotch::apps
