#pragma once

#include <vector>

#include "core/one_step_terrain.hpp"
#include "core/terrain_map.hpp"
#include "perception/one_step.hpp"
#include "perception/perception_config.hpp"

namespace hopscotch::perception {

/// A level or sloped stretch along the jump line.
struct SurveyedTread {
  double start = core::kNaN;      ///< In S [m].
  double end = core::kNaN;        ///< In S [m].
  double height = core::kNaN;     ///< At its middle, in S [m].
  double slope = core::kNaN;      ///< Rise along the line [rad].
  double roughness = core::kNaN;  ///< Between the 5th and 95th percentile about its line [m].
  int slices = 0;                 ///< Observed across both foot tracks.
};

/// What lies along the jump line, for people and records: farther than one jump needs to know.
struct LineSurvey {
  std::vector<SurveyedTread> treads;  ///< Ascending.
  core::OneStepTerrain features;      ///< Its edges and gaps; the profile is left empty.
  std::vector<double> step_sigmas;    ///< Of the step of each edge [m].

  /// The tread that the robot stands on, or else the first one ahead; null without any.
  [[nodiscard]] const SurveyedTread* ground() const;
};

/// @param to_x  End of the survey, in S [m].
[[nodiscard]] LineSurvey survey_line(const OneStepConfig& config, const core::TerrainMap& map,
                                     const StancePose& stance, double to_x);

}  // namespace hopscotch::perception
