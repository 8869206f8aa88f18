#include "apps/slope_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "apps/installation.hpp"
#include "apps/program_config.hpp"
#include "apps/shipped_jumps.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps {
namespace {

constexpr double kSlope = 0.15;  // [rad]

const ProgramConfig& config() {
  static const ProgramConfig loaded = ProgramConfig::load(config_directory() / "hopscotch.yaml");
  return loaded;
}

class SlopePlannerTest : public ::testing::Test {
 protected:
  /// A leap of 0.40 m on ground that rises by such angles before and behind its middle [rad].
  [[nodiscard]] core::LandingTarget leap(double from, double to) const {
    const double height = 0.2 * (std::tan(from) + std::tan(to));
    core::LandingTarget target =
        planner::step_target({.distance = 0.40, .height = height, .edge = 0.2}, robot_);
    for (int i = 0; i < core::TerrainProfile::kSamples; ++i) {
      const double x = core::TerrainProfile::x(i);
      const double z =
          x < 0.2 ? std::tan(from) * x : 0.2 * std::tan(from) + std::tan(to) * (x - 0.2);
      const auto at = static_cast<std::size_t>(i);
      target.profile.lower[at] = target.profile.mean[at] = target.profile.upper[at] = z;
    }
    return target;
  }

  [[nodiscard]] planner::PlanRequest request(const core::LandingTarget& target) const {
    return {
        .start =
            planner::start_state(planner::StartKind::stand, robot_, config().stand_posture).value(),
        .target = target,
        .final_posture = config().stand_posture};
  }

  /// Largest forward force per vertical one of the push-off's knots.
  static double steepest_push(const core::JumpPlan& plan) {
    double largest = 0.0;
    for (std::size_t i = 0; i < plan.knot_count; ++i) {
      const core::JumpKnot& knot = plan.knots[i];
      if (knot.phase != core::JumpPhase::takeoff) continue;
      const Eigen::Vector3d force = knot.wrenches[0].force + knot.wrenches[1].force;
      largest = std::max(largest, force.x() / force.z());
    }
    return largest;
  }

  model::RobotParameters robot_ = model::RobotParameters::load(robot_file("hector"));
  SlopePlanner planner_{config().planner, robot_, shipped_jumps("hector", config().planner.steps)};
};

TEST(LevelFriction, IsTheConesReachOverTheHorizontal) {
  EXPECT_NEAR(level_friction(0.5, 0.0, 0.0), 0.5, 1e-12);
  const double cone = std::atan(0.5);
  EXPECT_NEAR(level_friction(0.5, std::tan(0.15), 0.0), std::tan(cone - 0.15), 1e-12);
  EXPECT_NEAR(level_friction(0.5, -std::tan(0.15), 0.0), std::tan(cone + 0.15), 1e-12);
  // Across, the weight takes its share of the cone.
  EXPECT_NEAR(level_friction(0.5, 0.0, 0.3), std::sqrt(1.25 / 1.09 - 1.0), 1e-12);
  EXPECT_EQ(level_friction(0.5, 0.0, 0.6), 0.0);
}

TEST_F(SlopePlannerTest, LevelGroundAndSlopesThatHelpKeepTheWholeFriction) {
  EXPECT_EQ(planner_.friction_for(leap(0.0, 0.0)), config().planner.friction);
  EXPECT_EQ(planner_.friction_for(leap(0.0, kSlope)), config().planner.friction);
  EXPECT_EQ(planner_.friction_for(leap(-kSlope, 0.0)), config().planner.friction);
  EXPECT_EQ(planner_.friction_for(leap(0.008, -0.008)), config().planner.friction);  // scatter
}

TEST_F(SlopePlannerTest, APushOffUphillAndALandingDownhillHaveLess) {
  const double share = config().planner.reserves.friction;
  const double left = level_friction(share * config().planner.friction, std::tan(kSlope), 0.0);
  EXPECT_NEAR(planner_.friction_for(leap(kSlope, kSlope)), left / share, 1e-9);
  EXPECT_NEAR(planner_.friction_for(leap(0.0, -kSlope)), left / share, 1e-3);
  core::LandingTarget across = leap(0.0, 0.0);
  across.X_WF[0].translation().z() += 0.1 * std::tan(kSlope);
  across.X_WF[1].translation().z() -= 0.1 * std::tan(kSlope);
  EXPECT_LT(planner_.friction_for(across), config().planner.friction);
}

TEST_F(SlopePlannerTest, ALeapUphillPushesLessAlongTheGround) {
  const core::Result<core::JumpPlan> level = planner_.plan(request(leap(0.0, kSlope)));
  const core::Result<core::JumpPlan> uphill = planner_.plan(request(leap(kSlope, kSlope)));
  ASSERT_TRUE(level && uphill);
  const double holds = std::tan(std::atan(0.35) - kSlope);
  EXPECT_GT(steepest_push(*level), holds + 0.05);
  EXPECT_LT(steepest_push(*uphill), holds + 0.01);
}

}  // namespace
}  // namespace hopscotch::apps
