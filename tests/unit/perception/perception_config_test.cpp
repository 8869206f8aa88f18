#include "perception/perception_config.hpp"

#include <gtest/gtest.h>

#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

TEST(PerceptionConfig, ProjectTuningLoadsCompletely) {
  const PerceptionConfig config = test::perception_config();
  EXPECT_DOUBLE_EQ(config.mapper.resolution, 0.010);
  EXPECT_GT(config.filter.range_max, 1.5);
  EXPECT_GT(config.one_step.pit_depth, 0.28) << "a jump down must not be taken for a pit";
}

TEST(PerceptionConfig, RangeThatIsEmptyIsRejectedByName) {
  const core::ConfigReader section = core::ConfigReader::from_text(
      "range_min_m: 2.0\nrange_max_m: 1.0\njump_ratio: 0.03\njump_sigmas: 5.0\n"
      "mask_margin_m: 0.02\nmask_margin_px: 2\n",
      "test.yaml");
  try {
    DepthFilterConfig::load(section);
    FAIL() << "was accepted";
  } catch (const core::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("range_max_m"), std::string::npos) << error.what();
  }
}

TEST(PerceptionConfig, UnknownKeyIsRejected) {
  const core::ConfigReader section = core::ConfigReader::from_text(
      "base_m: 0.001\nquadratic_per_m: 0.0036\nfloor_m: 0.002\ntilt_rad: 0.002\nbias_m: 0.1\n",
      "test.yaml");
  EXPECT_THROW(DepthNoiseConfig::load(section), core::ConfigError);
}

}  // namespace
}  // namespace hopscotch::perception
