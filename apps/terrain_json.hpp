#pragma once

#include <string>
#include <vector>

#include "core/landing_target.hpp"
#include "core/one_step_terrain.hpp"
#include "core/time.hpp"
#include "perception/line_survey.hpp"

namespace hopscotch::apps {

/// A flat piece of ground as it is reported.
struct ReportedPlane {
  double height = 0.0;  ///< Of its centre, in W [m].
  double slope = 0.0;   ///< Against level [rad].
  int points = 0;
};

/// One look at the terrain and what was made of it.
struct TerrainReport {
  core::Stamp stamp;
  std::string status = "ok";
  core::OneStepTerrain terrain;  ///< Its profile and coverage; edges and gaps come from `survey`.
  perception::LineSurvey survey;
  std::vector<ReportedPlane> planes;
  core::TargetChoice choice;
  double latency_ms = 0.0;
};

/// `hopscotch.terrain/1` on one line. Heights of edges, steps and targets are above S, those of
/// ground and planes in W; what is unknown is null.
[[nodiscard]] std::string terrain_json(const TerrainReport& report);

}  // namespace hopscotch::apps
