#include "planner/planner_config.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

/// The shipped file with one piece of text replaced.
PlannerConfig load_with(const std::string& text, const std::string& replacement) {
  std::ifstream file(testing_support::config_folder() / "hopscotch.yaml");
  std::stringstream content;
  content << file.rdbuf();
  std::string yaml = content.str();
  const std::size_t at = yaml.find(text, yaml.find("\nplanner:"));
  EXPECT_NE(at, std::string::npos) << text;
  yaml.replace(at, text.size(), replacement);
  return PlannerConfig::load(core::ConfigReader::from_text(yaml, "test.yaml").section("planner"));
}

TEST(PlannerConfig, LoadsTheShippedFile) {
  const PlannerConfig config = testing_support::shipped_config();
  EXPECT_GT(config.steps.takeoff, 0);
  EXPECT_LE(config.flight_step_min, config.flight_step_max);
  EXPECT_LE(config.landing_step_min, config.landing_step_max);
}

TEST(PlannerConfig, HardLeapsMayLandLonger) {
  const PlannerConfig config = testing_support::shipped_config();
  EXPECT_EQ(config.landing_step_longest(0.25, -0.30), config.landing_step_max);
  EXPECT_EQ(config.landing_step_longest(0.40, 0.0), config.landing_step_max);
  EXPECT_EQ(config.landing_step_longest(0.40, 0.25), config.landing_step_hard);
  EXPECT_EQ(config.landing_step_longest(0.60, 0.0), config.landing_step_hard);
  const double between = config.landing_step_longest(0.43, 0.045);
  EXPECT_NEAR(between, 0.5 * (config.landing_step_max + config.landing_step_hard), 1e-9);
}

TEST(PlannerConfig, RejectsUnknownKeysAndBrokenRanges) {
  EXPECT_THROW(load_with("knee_m:", "elbow_m:"), core::ConfigError);
  EXPECT_THROW(load_with("iterations_max:", "iterations_max: 0 #"), core::ConfigError);
  EXPECT_THROW(load_with("shank_pitch_max_rad:", "shank_pitch_max_rad: -1 #"), core::ConfigError);
}

TEST(PlannerConfig, RejectsStepLengthsUpsideDown) {
  EXPECT_THROW(load_with("landing_step_min_ms:", "landing_step_min_ms: 45 #"), core::ConfigError);
  EXPECT_THROW(load_with("landing_step_hard_ms:", "landing_step_hard_ms: 25 #"), core::ConfigError);
  EXPECT_THROW(load_with("flight_step_max_ms:", "flight_step_max_ms: 4 #"), core::ConfigError);
}

TEST(PlannerConfig, TakeoffStepsAddUpToItsTime) {
  const PlannerConfig config = testing_support::shipped_config();
  double sum = 0.0;
  for (int k = 0; k < config.steps.takeoff; ++k) sum += config.takeoff_step(k);
  EXPECT_NEAR(sum, config.takeoff_time(), 1e-12);
}

}  // namespace
}  // namespace hopscotch::planner
