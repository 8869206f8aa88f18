#include "planner/replanner.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "model/knot_state.hpp"
#include "planner/jump_planner.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::hector;
using testing_support::request;
using testing_support::shipped_config;

/// Landings are planned with no more room at toe and heel than their rests are.
PlannerConfig config() {
  PlannerConfig config = shipped_config();
  config.landing_cop_margin = config.takeoff_cop_margin;
  return config;
}

/// A leap of 0.40 m as it was planned from standing.
class RestOfAJump : public testing::Test {
 protected:
  RestOfAJump() {
    JumpPlanner planner(config(), hector());
    plan_ = *planner.plan(request(0.40, 0.0));
    whole_ = std::make_shared<const KnownJump>(*planner.last());
  }

  /// From takeoff step `steps_done` on, the robot being where the plan has it.
  [[nodiscard]] RestRequest rest(int steps_done) const {
    return {.id = plan_.id,
            .whole = whole_,
            .steps_done = steps_done,
            .state = model::state_of(plan_.knots[static_cast<std::size_t>(steps_done)]),
            .target = plan_.target,
            .final_posture = testing_support::shipped_posture()};
  }

  /// The same with a trunk that turns faster by `rate` [rad/s] than planned, on legs that do not.
  [[nodiscard]] RestRequest pushed(int steps_done, double rate) const {
    RestRequest request = rest(steps_done);
    request.state.w_WB.y() += rate;
    for (const core::Leg leg : core::kAllLegs) {
      request.state.dq[core::joint_index(leg, core::Joint::hip_pitch)] -= rate;
    }
    return request;
  }

  /// Steps done at landing knot `k`.
  [[nodiscard]] static int landed(int k) {
    return config().steps.takeoff + config().steps.flight + k;
  }

  core::JumpPlan plan_;
  std::shared_ptr<const KnownJump> whole_;
};

/// The principle of optimality. Of the smoothness one step's part is not counted, which shows when
/// few are left.
TEST_F(RestOfAJump, OfTheBestJumpIsTheBestRest) {
  struct Case {
    int done;
    double off_max;  // [rad]
  };
  for (const auto [done, off_max] :
       {Case{0, 0.002}, Case{5, 0.005}, Case{10, 0.01}, Case{20, 0.04}, Case{landed(0), 0.002},
        Case{landed(4), 0.002}, Case{landed(10), 0.002}}) {
    Replanner replanner(config(), hector());
    const core::Result<core::JumpPlan> found = replanner.replan(rest(done));
    ASSERT_TRUE(found) << done << ": " << found.error().text();
    EXPECT_LE(replanner.iterations(), 12) << done;
    const auto first = static_cast<std::size_t>(done);
    ASSERT_EQ(found->knot_count, plan_.knot_count - first);
    for (std::size_t i = 0; i < found->knot_count; ++i) {
      const core::JumpKnot& was = plan_.knots[first + i];
      EXPECT_NEAR((found->knots[i].q - was.q).cwiseAbs().maxCoeff(), 0.0, off_max) << done;
      EXPECT_NEAR(found->knots[i].time + plan_.knots[first].time, was.time, 0.003) << done;
    }
  }
}

TEST_F(RestOfAJump, StartsWhereTheRobotIsAndEndsAtTheTarget) {
  for (const int done : {3, 10, 15, 20, landed(1), landed(6)}) {
    Replanner replanner(config(), hector());
    const RestRequest request = pushed(done, 0.4);
    const core::Result<core::JumpPlan> found = replanner.replan(request);
    ASSERT_TRUE(found) << done << ": " << found.error().text();
    EXPECT_NEAR(found->knots[0].w_WB.y(), request.state.w_WB.y(), 1e-9);
    EXPECT_NEAR((found->knots[0].q - request.state.q).norm(), 0.0, 1e-9);
    const core::JumpKnot& end = found->knots[found->knot_count - 1];
    const core::JumpKnot& planned_end = plan_.knots[plan_.knot_count - 1];
    EXPECT_NEAR((end.p_WG - planned_end.p_WG).norm(), 0.0, 1e-6);
    EXPECT_NEAR(end.v_WG.norm(), 0.0, 1e-9);
    EXPECT_GE(found->certificate.binding().margin, -1e-3);
    EXPECT_LE(found->certificate.dense_max_violation, 1e-3);
    EXPECT_EQ(found->id, plan_.id);
  }
}

TEST_F(RestOfAJump, IsPlannedFromTheLastRest) {
  Replanner replanner(config(), hector());
  ASSERT_TRUE(replanner.replan(pushed(8, 0.4)));
  const core::Result<core::JumpPlan> once = replanner.replan(pushed(8, 0.4));
  ASSERT_TRUE(once);
  RestRequest later = pushed(8, 0.0);
  later.steps_done = 11;
  later.state = model::state_of(once->knots[3]);
  const core::Result<core::JumpPlan> again = replanner.replan(later);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_LE(replanner.iterations(), 12);
  EXPECT_NEAR((again->knots[10].q - once->knots[13].q).norm(), 0.0, 0.02);
}

/// What was left of the takeoff last is what the landing is taken from.
TEST_F(RestOfAJump, OfALandingFollowsThatOfItsTakeoff) {
  Replanner replanner(config(), hector());
  const core::Result<core::JumpPlan> takeoff = replanner.replan(pushed(8, 0.4));
  ASSERT_TRUE(takeoff);
  RestRequest later = pushed(8, 0.0);
  later.steps_done = landed(4);
  later.state = model::state_of(takeoff->knots[static_cast<std::size_t>(landed(4) - 8)]);
  const core::Result<core::JumpPlan> landing = replanner.replan(later);
  ASSERT_TRUE(landing) << landing.error().text();
  EXPECT_LE(replanner.iterations(), 12);
  EXPECT_EQ(landing->knots[0].phase, core::JumpPhase::landing);
  EXPECT_EQ(landing->touchdown_time, 0.0);
  const std::size_t same = static_cast<std::size_t>(landed(8) - 8);
  EXPECT_NEAR((landing->knots[4].q - takeoff->knots[same].q).norm(), 0.0, 0.01);
}

TEST_F(RestOfAJump, KnowsWhichLandingStepsHaveBegun) {
  const core::JumpKnot* const touchdown = &plan_.knots[static_cast<std::size_t>(landed(0))];
  for (int k = 0; k < config().steps.landing; ++k) {
    const double begin = touchdown[k].time - touchdown->time;
    EXPECT_EQ(landing_steps_begun(config(), *whole_, begin + 1e-6), k + 1);
    EXPECT_EQ(landing_steps_begun(config(), *whole_, begin - 1e-6), k);
  }
  EXPECT_EQ(landing_steps_begun(config(), *whole_, 10.0), config().steps.landing);
}

TEST_F(RestOfAJump, RepeatsToTheBit) {
  Replanner one(config(), hector());
  Replanner other(config(), hector());
  const core::Result<core::JumpPlan> a = one.replan(pushed(12, 0.3));
  const core::Result<core::JumpPlan> b = other.replan(pushed(12, 0.3));
  ASSERT_TRUE(a);
  ASSERT_TRUE(b);
  for (std::size_t i = 0; i < a->knot_count; ++i) {
    EXPECT_EQ(a->knots[i].q, b->knots[i].q);
    EXPECT_EQ(a->knots[i].tau, b->knots[i].tau);
  }
}

TEST_F(RestOfAJump, ThatCannotBePlannedLeavesThePlanInHand) {
  Replanner replanner(config(), hector());
  const int steps = config().steps.takeoff;
  for (const int done : {steps - 1, steps + 2, static_cast<int>(plan_.knot_count) - 2}) {
    EXPECT_EQ(replanner.replan(rest(done)).error().reason, core::Reason::target_malformed);
  }
  RestRequest early = rest(0);
  early.steps_done = -1;
  EXPECT_EQ(replanner.replan(early).error().reason, core::Reason::target_malformed);
  RestRequest unknown = rest(5);
  unknown.state.v_WB.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(replanner.replan(unknown).error().reason, core::Reason::bad_sensor_value);
  EXPECT_EQ(replanner.replan(pushed(15, 15.0)).error().reason, core::Reason::plan_infeasible);
  RestRequest aside = rest(5);
  for (Eigen::Isometry3d& X_WF : aside.target.X_WF) X_WF.translation().y() += 0.05;
  EXPECT_EQ(replanner.replan(aside).error().reason, core::Reason::out_of_reach);
  EXPECT_TRUE(replanner.replan(rest(5)));
}

}  // namespace
}  // namespace hopscotch::planner
