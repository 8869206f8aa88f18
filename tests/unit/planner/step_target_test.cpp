#include "planner/step_target.hpp"

#include <gtest/gtest.h>

#include "model/kinematics.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

TEST(StepTarget, PutsTheSolesBesideTheTargetPoint) {
  const core::LandingTarget target =
      step_target({.distance = 0.4, .height = 0.1, .edge = 0.28}, testing_support::hector());
  const Eigen::Vector3d middle =
      0.5 * (target.X_WF[0].translation() + target.X_WF[1].translation());
  EXPECT_TRUE(middle.isApprox(Eigen::Vector3d(0.4, 0.0, 0.1), 1e-12));
  EXPECT_GT(target.X_WF[0].translation().y(), target.X_WF[1].translation().y());
}

TEST(StepTarget, ChangesHeightAtTheEdge) {
  const core::LandingTarget target =
      step_target({.distance = 0.4, .height = 0.1, .edge = 0.28}, testing_support::hector());
  EXPECT_EQ(target.profile.upper[static_cast<std::size_t>(core::TerrainProfile::sample(0.25))],
            0.0);
  EXPECT_EQ(target.profile.upper[static_cast<std::size_t>(core::TerrainProfile::sample(0.31))],
            0.1);
}

TEST(StepTarget, EdgeDefaultsToTheNearEndOfADropAndTheFarEndOfARise) {
  EXPECT_DOUBLE_EQ(default_edge(0.4, -0.2), 0.12);
  EXPECT_DOUBLE_EQ(default_edge(0.4, 0.2), 0.28);
}

TEST(StandingState, StandsOnTheOriginWithBothFeet) {
  const model::RobotParameters robot = testing_support::hector();
  const core::RobotState state =
      standing_state(*model::stand_pose(robot, testing_support::shipped_posture()));
  const std::array<Eigen::Isometry3d, core::kLegs> soles = model::sole_poses(robot, state);
  const Eigen::Vector3d middle = 0.5 * (soles[0].translation() + soles[1].translation());
  EXPECT_LT(middle.norm(), 1e-9);
  EXPECT_TRUE(state.contact[0] && state.contact[1]);
}

}  // namespace
}  // namespace hopscotch::planner
