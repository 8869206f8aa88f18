#include "apps/shipped_jumps.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "apps/installation.hpp"
#include "apps/program_config.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"
#include "model/robot_parameters.hpp"
#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps {
namespace {

const ProgramConfig& config() {
  static const ProgramConfig loaded = ProgramConfig::load(config_directory() / "hopscotch.yaml");
  return loaded;
}

TEST(ShippedJumps, AreAtMostFiveMegabytes) {
  EXPECT_LE(std::filesystem::file_size(jumps_file("hector")), 5'000'000U);
}

TEST(ShippedJumps, NineOfTenAreCertifiedWithTheShippedTuning) {
  // After a change of limits or robot: `hopscotch library`.
  const model::RobotParameters robot = model::RobotParameters::load(robot_file("hector"));
  planner::PlannerConfig tuning = config().planner;
  const auto library = shipped_jumps("hector", tuning.steps);
  ASSERT_TRUE(library);
  ASSERT_GE(library->jumps().size(), 250U);
  tuning.iterations_max = 1;  // nothing is solved that the library does not know already
  planner::JumpPlanner planner(tuning, robot, library);
  int tried = 0;
  int certified = 0;
  const auto start =
      planner::start_state(planner::StartKind::stand, robot, config().stand_posture).value();
  for (std::size_t i = 0; i < library->jumps().size(); i += 5) {
    const planner::KnownJump& jump = library->jumps()[i];
    const planner::StepRequest step{.distance = jump.distance,
                                    .height = jump.height,
                                    .edge = planner::default_edge(jump.distance, jump.height)};
    const planner::PlanRequest request{.start = start,
                                       .target = planner::step_target(step, robot),
                                       .final_posture = config().stand_posture};
    const bool from_stand = jump.start.rate == model::LinkArray<double>{} &&
                            jump.start.pitch == library->jumps()[0].start.pitch;
    if (!from_stand) continue;
    ++tried;
    const bool planned = planner.plan(request).has_value();
    if (planned && planner.rung() != planner::PlanRung::solved) ++certified;
  }
  EXPECT_GE(tried, 25);
  EXPECT_GE(certified, 0.9 * tried);
}

TEST(ShippedJumps, ARobotWithoutALibraryHasNone) {
  EXPECT_EQ(shipped_jumps("nobody", config().planner.steps), nullptr);
}

TEST(ShippedJumps, OtherStepsAreRefusedWithTheWayOut) {
  planner::StepCounts steps = config().planner.steps;
  steps.landing += 1;
  try {
    (void)shipped_jumps("hector", steps);
    FAIL();
  } catch (const core::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("hopscotch library"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("hector.jumps"), std::string::npos);
  }
}

TEST(ShippedJumps, ABrokenFileIsNamed) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "hopscotch-broken-library.jumps";
  write_file_atomically(file, "hopscotch jumps 1\n and then nothing of use");
  try {
    (void)read_jumps(file);
    FAIL();
  } catch (const core::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("hopscotch-broken-library"), std::string::npos);
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace hopscotch::apps
