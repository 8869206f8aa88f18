#include "planner/warm_start.hpp"

#include "planner/decision_bounds.hpp"
#include "tests/unit/planner/phase_fixture.hpp"

namespace hopscotch::planner {
namespace {

using WarmStart = testing_support::PhaseTest;

TEST_F(WarmStart, BeginsAtTheStartAndEndsInTheFinalPosture) {
  const DecisionBounds bounds = decision_bounds(model_, task_, layout_);
  constexpr double kClosedForm = 1e-6;
  for (int d = 0; d < kStanceDof; ++d) {
    EXPECT_NEAR(guess_(d), bounds.lower(d), kClosedForm);
    const int end = layout_.landing(layout_.steps().landing) + d;
    EXPECT_NEAR(guess_(end), bounds.lower(end), kClosedForm);
  }
}

TEST_F(WarmStart, FliesAParabolaOntoTheTarget) {
  const PlanarMotion motion = motion_from_decision(model_, task_, layout_, guess_);
  const PlanarKnot& last =
      motion.knots[static_cast<std::size_t>(layout_.steps().takeoff + layout_.steps().flight - 1)];
  const PlanarInstant touchdown = instant(model_, motion, last, last.dt);
  constexpr double kRoughly = 0.05;  // accelerations come from differences
  EXPECT_NEAR(touchdown.ankle.x, motion.target_ankle.x, kRoughly);
  EXPECT_NEAR(touchdown.ankle.z, motion.target_ankle.z, kRoughly);
}

TEST_F(WarmStart, IsFiniteForEveryTargetInAndOutOfReach) {
  for (double height = -0.5; height <= 0.5; height += 0.1) {
    for (double distance = 0.05; distance <= 1.0; distance += 0.05) {
      const auto far = planar_task(model_, testing_support::request(distance, height));
      if (!far) continue;  // the sole would stand in the step
      EXPECT_TRUE(kinematic_guess(model_, *far, layout_).allFinite()) << distance << " " << height;
    }
  }
}

}  // namespace
}  // namespace hopscotch::planner
