#include "apps/shipped_jumps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/installation.hpp"
#include "apps/program_config.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"
#include "footstep/reachability.hpp"
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

planner::PlanRequest from_standing(const model::RobotParameters& robot, double distance,
                                   double height) {
  const planner::StepRequest step{
      .distance = distance, .height = height, .edge = planner::default_edge(distance, height)};
  return {
      .start =
          planner::start_state(planner::StartKind::stand, robot, config().stand_posture).value(),
      .target = planner::step_target(step, robot),
      .final_posture = config().stand_posture};
}

TEST(ShippedJumps, HighStepsBetweenThemAreSolvedToWhereTheyWereAskedFor) {
  const model::RobotParameters robot = model::RobotParameters::load(robot_file("hector"));
  planner::JumpPlanner planner(config().planner, robot,
                               shipped_jumps("hector", config().planner.steps));
  for (const auto& [distance, height] : {std::pair{0.258, 0.25}, std::pair{0.266, 0.256}}) {
    const auto plan = planner.plan(from_standing(robot, distance, height));
    ASSERT_TRUE(plan) << plan.error().text();
    EXPECT_EQ(planner.rung(), planner::PlanRung::neighbour);
    EXPECT_EQ(plan->target.distance, distance);
    EXPECT_EQ(plan->target.height, height);
  }
}

TEST(ShippedJumps, NoJumpToAnotherPlaceIsAnAnswer) {
  const model::RobotParameters robot = model::RobotParameters::load(robot_file("hector"));
  planner::JumpPlanner planner(config().planner, robot,
                               shipped_jumps("hector", config().planner.steps));
  int planned = 0;
  for (double distance = 0.60; distance < 0.68; distance += 0.005) {
    const auto plan = planner.plan(from_standing(robot, distance, 0.0));
    if (!plan) continue;
    ++planned;
    EXPECT_NEAR(plan->target.distance, distance, 1.1e-3);
  }
  EXPECT_GT(planned, 0);
}

TEST(ShippedJumps, CorrectionsThatOvershootSettleByHalves) {
  const model::RobotParameters robot = model::RobotParameters::load(robot_file("hector"));
  planner::JumpPlanner planner(config().planner, robot,
                               shipped_jumps("hector", config().planner.steps));
  for (const auto& [distance, height] : {std::pair{0.4337, 0.1955}, std::pair{0.6424, -0.1115}}) {
    const auto plan = planner.plan(from_standing(robot, distance, height));
    ASSERT_TRUE(plan) << plan.error().text();
    EXPECT_EQ(planner.rung(), planner::PlanRung::neighbour);
    EXPECT_EQ(plan->target.distance, distance);
  }
}

TEST(ShippedJumps, NoPlanOrRefusalTakesMoreThanItsShareOfIterations) {
  constexpr int kIterationsInAll = 170;  // docs/decisions/0076
  const model::RobotParameters robot = model::RobotParameters::load(robot_file("hector"));
  planner::JumpPlanner planner(config().planner, robot,
                               shipped_jumps("hector", config().planner.steps));
  int most = 0;
  for (const auto& [distance, height] :
       {std::pair{0.282, 0.2685}, std::pair{0.654, -0.101}, std::pair{0.447, 0.195}}) {
    (void)planner.plan(from_standing(robot, distance, height));
    EXPECT_LE(planner.iterations(), kIterationsInAll) << distance << " m, " << height << " m up";
    most = std::max(most, planner.iterations());
  }
  EXPECT_EQ(most, kIterationsInAll);  // else these targets have become easy: take others
}

/// Whether footstep lets a robot that stands `edge` behind a change of height jump there, with room
/// for the soles beside that edge. A riser right before the toes is the planner's to refuse.
bool footstep_allows(const model::RobotParameters& robot, const planner::StepRequest& step) {
  constexpr double kSoleMargin = 0.035;  // [m]
  constexpr double kRiserMargin = 0.11;  // [m]
  const double half_sole = 0.5 * (robot.toe + robot.heel);
  return step.distance - step.edge >= half_sole + kSoleMargin &&
         (step.height < 0.0 || step.edge >= half_sole + kRiserMargin) &&
         footstep::reach_verdict(
             config().footstep.reach,
             {.distance = step.distance, .height = step.height, .takeoff_edge = step.edge}) ==
             core::Reason::none;
}

TEST(ShippedJumps, WhatFootstepAllowsIsPlanned) {
  const model::RobotParameters robot = model::RobotParameters::load(robot_file("hector"));
  const auto start =
      planner::start_state(planner::StartKind::stand, robot, config().stand_posture).value();
  planner::JumpPlanner planner(config().planner, robot,
                               shipped_jumps("hector", config().planner.steps));
  int tried = 0;
  for (const double height : {-0.28, -0.24, -0.20, -0.16, -0.12, -0.08, 0.08, 0.12, 0.16, 0.20}) {
    for (double distance = 0.28; distance < 0.56; distance += 0.033) {
      for (const double edge : {0.12, 0.15, 0.175, 0.20}) {
        const planner::StepRequest step{.distance = distance, .height = height, .edge = edge};
        if (!footstep_allows(robot, step)) continue;
        ++tried;
        const auto plan = planner.plan({.start = start,
                                        .target = planner::step_target(step, robot),
                                        .final_posture = config().stand_posture});
        EXPECT_TRUE(plan) << distance << " m along, " << height << " m up, edge at " << edge
                          << " m: " << (plan ? "" : plan.error().text());
      }
    }
  }
  EXPECT_GT(tried, 100);
}

}  // namespace
}  // namespace hopscotch::apps
