#include <gtest/gtest.h>

#include <memory>

#include "planner/jump_library.hpp"
#include "planner/jump_planner.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::hector;
using testing_support::request;
using testing_support::shipped_config;

/// So few iterations that a jump is solved from a neighbour, but not from the closed-form guess.
constexpr int kFewIterations = 7;

PlannerConfig with_iterations(int count) {
  PlannerConfig config = shipped_config();
  config.iterations_max = count;
  return config;
}

/// The leap of 0.40 m, solved in full.
class PlanLadder : public testing::Test {
 protected:
  PlanLadder() {
    JumpPlanner planner(shipped_config(), hector());
    EXPECT_TRUE(planner.plan(request(0.40, 0.0)));
    JumpLibrary library("hector", shipped_config().steps);
    library.add(*planner.last());
    library_ = std::make_shared<const JumpLibrary>(JumpLibrary::from_bytes(library.bytes()));
  }

  [[nodiscard]] JumpPlanner planner_with(int iterations) const {
    return {with_iterations(iterations), hector(), library_};
  }

  std::shared_ptr<const JumpLibrary> library_;
};

TEST_F(PlanLadder, FirstRungIsTheSolve) {
  JumpPlanner planner = planner_with(shipped_config().iterations_max);
  PlanRequest leap = request(0.41, 0.0);
  leap.guess = StartGuess::kinematic;
  const core::Result<core::JumpPlan> plan = planner.plan(leap);
  ASSERT_TRUE(plan);
  EXPECT_EQ(planner.rung(), PlanRung::solved);
  EXPECT_FALSE(plan->warm);
}

TEST_F(PlanLadder, ANeighbourFromTheLibraryIsTheStartWhereThereIsOne) {
  JumpPlanner planner = planner_with(shipped_config().iterations_max);
  const core::Result<core::JumpPlan> near = planner.plan(request(0.41, 0.0));
  ASSERT_TRUE(near);
  EXPECT_EQ(planner.rung(), PlanRung::neighbour);
  EXPECT_TRUE(near->warm);
  ASSERT_TRUE(planner.plan(request(0.30, 0.10)));
  EXPECT_EQ(planner.rung(), PlanRung::solved);  // no jump of the library is like that
}

TEST_F(PlanLadder, WhatCannotBeSolvedFromTheGuessIsSolvedFromANeighbour) {
  JumpPlanner alone(with_iterations(kFewIterations), hector());
  ASSERT_FALSE(alone.plan(request(0.41, 0.0)));
  JumpPlanner planner = planner_with(kFewIterations);
  const core::Result<core::JumpPlan> plan = planner.plan(request(0.41, 0.0));
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_EQ(planner.rung(), PlanRung::neighbour);
  EXPECT_TRUE(plan->warm);
  EXPECT_EQ(plan->target.distance, 0.41);
  EXPECT_GT(plan->certificate.binding().margin, 0.0);
}

/// With room around the landing place, as on a wide tread.
PlanRequest roomy_request(double distance, double height) {
  PlanRequest roomy = request(distance, height);
  roomy.target.margin = 0.1;
  return roomy;
}

TEST_F(PlanLadder, WithoutANeighbourThatSolvesALibraryJumpIsTakenAsItIs) {
  JumpPlanner planner = planner_with(1);
  const core::Result<core::JumpPlan> plan = planner.plan(roomy_request(0.42, 0.005));
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_EQ(planner.rung(), PlanRung::library);
  // It says where it really lands.
  EXPECT_NEAR(plan->target.distance, 0.40, 1e-6);
  EXPECT_NEAR(plan->target.X_WF[0].translation().x(), 0.40, 1e-6);
  EXPECT_NEAR(plan->target.X_WF[0].translation().z(), 0.005, 1e-9);
  EXPECT_GT(plan->certificate.binding().margin, 0.0);
  EXPECT_LT(plan->certificate.dense_max_violation, 1e-3);
}

TEST_F(PlanLadder, BelowTheLastRungTheRobotStands) {
  JumpPlanner planner = planner_with(1);
  EXPECT_FALSE(planner.plan(roomy_request(0.45, 0.0)));   // no jump of the library ends there
  EXPECT_FALSE(planner.plan(roomy_request(0.40, 0.03)));  // nor so high
  PlanRequest leaning = roomy_request(0.40, 0.0);
  leaning.start.q(core::joint_index(core::Leg::left, core::Joint::knee)) += 0.2;
  leaning.start.q(core::joint_index(core::Leg::right, core::Joint::knee)) += 0.2;
  leaning.start.q(core::joint_index(core::Leg::left, core::Joint::ankle)) -= 0.2;
  leaning.start.q(core::joint_index(core::Leg::right, core::Joint::ankle)) -= 0.2;
  EXPECT_FALSE(planner.plan(leaning));  // nor begins so
}

TEST_F(PlanLadder, ALibraryJumpIsJudgedByTheGroundAsItIs) {
  JumpPlanner planner = planner_with(1);
  PlanRequest hurdle = request(0.40, 0.0);
  for (int i = 0; i < core::TerrainProfile::kSamples; ++i) {
    const double x = core::TerrainProfile::x(i);
    if (x < 0.17 || x > 0.23) continue;
    const auto at = static_cast<std::size_t>(i);
    for (auto* height : {&hurdle.target.profile.lower, &hurdle.target.profile.mean,
                         &hurdle.target.profile.upper}) {
      (*height)[at] = 0.12;
    }
  }
  const core::Result<core::JumpPlan> plan = planner.plan(hurdle);
  ASSERT_FALSE(plan);
  EXPECT_NE(planner.rung(), PlanRung::solved);
}

TEST_F(PlanLadder, LandingKeepsItsDistanceFromTheEdges) {
  JumpPlanner planner = planner_with(1);
  PlanRequest narrow = request(0.42, 0.0);
  narrow.target.margin = 0.01;  // less than the library's jump is off
  EXPECT_FALSE(planner.plan(narrow));
  narrow.target.margin = 0.03;
  EXPECT_TRUE(planner.plan(narrow));
}

TEST_F(PlanLadder, ARefusalIsThatOfTheFirstRung) {
  JumpPlanner with = planner_with(shipped_config().iterations_max);
  JumpPlanner without(shipped_config(), hector());
  const core::Result<core::JumpPlan> a = with.plan(request(0.60, 0.30));
  const core::Result<core::JumpPlan> b = without.plan(request(0.60, 0.30));
  ASSERT_FALSE(a);
  ASSERT_FALSE(b);
  EXPECT_EQ(a.error().text(), b.error().text());
  EXPECT_EQ(with.obstacle(), without.obstacle());
}

TEST_F(PlanLadder, RefusesALibraryOfOtherSteps) {
  PlannerConfig config = shipped_config();
  config.steps.flight -= 1;
  EXPECT_THROW(JumpPlanner(config, hector(), library_), std::invalid_argument);
}

}  // namespace
}  // namespace hopscotch::planner
