#include "footstep/footstep_config.hpp"

#include <gtest/gtest.h>

#include "tests/unit/footstep/known_course.hpp"

namespace hopscotch::footstep {
namespace {

constexpr const char* kReach =
    "distance_min_m: [0.1, 0.1]\ndistance_max_m: [0.5, 0.5]\ntakeoff_edge_max_m: [1.0, 1.0]\n"
    "past_edge_min_m: [0.1, 0.1]\n"
    "takeoff_edge_reserve_m: 0.0\ndrop_min_m: 0.06\nhurdle_max_m: 0.08\nhead_room_m: "
    "0.85\nbody_half_width_m: 0.15\nlateral_max_m: "
    "0.05\nyaw_max_rad: 0.15\n";

TEST(FootstepConfig, ProjectTuningLoadsCompletely) {
  const FootstepConfig config = test::footstep_config();
  EXPECT_EQ(config.reach.distance_max.size(), config.reach.height.size());
  EXPECT_GE(config.preference.margin_wanted, config.foothold.margin_min);
}

TEST(FootstepConfig, ReachTableMustBeRectangular) {
  const auto reader = core::ConfigReader::from_text(
      std::string("height_m: [-0.2, 0.0, 0.2]\n") + kReach, "test.yaml");
  EXPECT_THROW(ReachConfig::load(reader), core::ConfigError);
}

TEST(FootstepConfig, ReachTableMustAscend) {
  const auto reader =
      core::ConfigReader::from_text(std::string("height_m: [0.2, -0.2]\n") + kReach, "test.yaml");
  EXPECT_THROW(ReachConfig::load(reader), core::ConfigError);
}

}  // namespace
}  // namespace hopscotch::footstep
