#pragma once

#include <cmath>

#include "footstep/foothold_score.hpp"
#include "footstep/footstep_config.hpp"
#include "footstep/landing_selector.hpp"
#include "tests/unit/perception/flat_map.hpp"

/// Courses that are known exactly, so that tests judge the choice and not the eyes.
namespace hopscotch::test {

inline footstep::FootstepConfig footstep_config() {
  return footstep::FootstepConfig::load(tuning().section("footstep"));
}

/// Everything the selector is given, for a robot at `x` along a course.
struct KnownCourse {
  explicit KnownCourse(const Course& course, double x = 0.0)
      : state(standing_at(course, x, top_at(course, x, 0.0), 0.0)), map(known_map(course)) {
    look_again();
  }

  /// The one-step terrain of the map as it is now.
  void look_again() {
    const perception::OneStepConfig one_step = perception_config().one_step;
    terrain = perception::one_step_terrain(one_step, map,
                                           perception::stance_pose(one_step, hector(), state));
  }

  [[nodiscard]] core::TargetChoice choose(const footstep::LandingTask& task = {}) const {
    return footstep::LandingSelector(footstep_config(), hector())
        .choose({map, terrain}, state, task);
  }
  [[nodiscard]] footstep::StanceOnMap stance() const {
    return {.map = map,
            .p_WS = terrain.p_WS,
            .heading = terrain.heading,
            .half_stance = 0.098,
            .half_length = 0.075,
            .half_width = 0.01};
  }

  core::RobotState state;
  core::TerrainMap map;
  core::OneStepTerrain terrain;
};

}  // namespace hopscotch::test
