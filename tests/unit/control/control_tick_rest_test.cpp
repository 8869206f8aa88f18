#include <gtest/gtest.h>

#include "control/control_tick.hpp"
#include "core/allocation_count.hpp"
#include "tests/unit/control/control_tick_fixture.hpp"

namespace hopscotch::control {
namespace {

using core::RobotPhase;

/// Takeoffs that are planned anew while they are under way.
class ControlTickRestTest : public testing::ControlTickFixture {
 protected:
  ControlTickRestTest() { plan_.id = 5; }

  /// The jump has been under way for so many ticks.
  ControlTick jumping(int ticks) {
    ControlTick control = standing();
    step(control);
    control.offer(plan_);
    for (int i = 0; i < ticks; ++i) step(control);
    return control;
  }
  /// What is left of the plan from a knot on, with a trunk that leans.
  core::JumpPlan rest_from(std::size_t knot, double lean) const {
    core::JumpPlan rest = plan_;
    const double begin = plan_.knots[knot].time;
    rest.knot_count = plan_.knot_count - knot;
    for (std::size_t i = 0; i < rest.knot_count; ++i) {
      rest.knots[i] = plan_.knots[knot + i];
      rest.knots[i].time -= begin;
      rest.knots[i].rpy.y() += lean;
      rest.knots[i].q.array() += lean;
    }
    rest.liftoff_time -= begin;
    rest.touchdown_time -= begin;
    rest.duration -= begin;
    return rest;
  }
};

TEST_F(ControlTickRestTest, AsksForTheNextKnotThatAnAnswerCanReach) {
  const ControlTick control = jumping(21);  // at 20 ms
  const auto question = control.rest_question(0.010);
  ASSERT_TRUE(question);
  const auto& [knot, begin] = question->place;
  EXPECT_GE(begin, 0.030);
  EXPECT_EQ(begin, plan_.knots[knot].time);
  EXPECT_LT(plan_.knots[knot - 1].time, 0.030 + 1e-9);
}

TEST_F(ControlTickRestTest, AsksOnlyWhileItPushesOff) {
  ControlTick control = standing();
  step(control);
  EXPECT_FALSE(control.rest_question(0.010));
  control.offer(plan_);
  run_to(control, RobotPhase::flight);
  EXPECT_FALSE(control.rest_question(0.010));
}

TEST_F(ControlTickRestTest, ExpectsTheBodyToKeepWhatItIsBesideThePlan) {
  ControlTick control = jumping(21);
  state_.w_WB.y() += 0.5;
  step(control);
  const auto question = control.rest_question(0.010);
  ASSERT_TRUE(question);
  const core::JumpKnot body = sample_plan(plan_, 0.021 - testing::kActuationDelay);
  const core::JumpKnot& knot = plan_.knots[question->place.knot];
  EXPECT_NEAR(question->state.w_WB.y() - knot.w_WB.y(), state_.w_WB.y() - body.w_WB.y(), 1e-9);
}

TEST_F(ControlTickRestTest, GoesOnByTheNewRest) {
  ControlTick control = jumping(21);
  const auto place = control.rest_question(0.010)->place;
  const std::size_t knot = place.knot;
  const core::JumpPlan rest = rest_from(knot, 0.1);
  const std::size_t allocations = core::allocation_count();
  ASSERT_TRUE(control.replace_rest(rest, place));
  EXPECT_EQ(core::allocation_count(), allocations);
  EXPECT_DOUBLE_EQ(control.plan().knots[knot - 1].q[0], plan_.knots[knot - 1].q[0]);
  EXPECT_DOUBLE_EQ(control.plan().knots[knot].q[0], plan_.knots[knot].q[0] + 0.1);
  EXPECT_NEAR(control.plan().knots[knot].time, plan_.knots[knot].time, 1e-12);
  EXPECT_NEAR(control.plan().liftoff_time, plan_.liftoff_time, 1e-12);
  EXPECT_NEAR(control.plan().duration, plan_.duration, 1e-12);
  EXPECT_FALSE(control.replace_rest(rest, place)) << "it has begun";
}

TEST_F(ControlTickRestTest, ARestThatComesTooLateChangesNothing) {
  ControlTick control = jumping(21);
  const auto place = control.rest_question(0.010)->place;
  const std::size_t knot = place.knot;
  const core::JumpPlan rest = rest_from(knot, 0.1);
  while (control.status().plan_time < plan_.knots[knot].time + 0.005) step(control);
  EXPECT_FALSE(control.replace_rest(rest, place));
  EXPECT_DOUBLE_EQ(control.plan().knots[knot].q[0], plan_.knots[knot].q[0]);
}

TEST_F(ControlTickRestTest, ARestOfAnotherJumpChangesNothing) {
  ControlTick control = jumping(21);
  const auto place = control.rest_question(0.010)->place;
  const std::size_t knot = place.knot;
  core::JumpPlan other = rest_from(knot, 0.1);
  other.id = plan_.id + 1;
  EXPECT_FALSE(control.replace_rest(other, place));
  core::JumpPlan shorter = rest_from(knot, 0.1);
  --shorter.knot_count;
  EXPECT_FALSE(control.replace_rest(shorter, place));
}

/// What the MPC wanted to change of the old plan, the new one has taken in.
TEST_F(ControlTickRestTest, AnAnswerOfTheMpcToTheOldPlanIsForgotten) {
  ControlTick control = jumping(21);
  MpcAnswer answer{
      .stamp = state_.stamp, .status = MpcStatus::solved, .form = MpcForm::error_state};
  answer.wrenches[0].force = {0.0, 0.0, 20.0};
  answer.planned[0].force = answer.wrenches[1].force = answer.planned[1].force = {0.0, 0.0, 0.0};
  control.answer(answer);
  step(control);
  EXPECT_GT((step(control).tau - sample_plan(plan_, 0.022).tau).norm(), 0.1);
  const auto place = control.rest_question(0.010)->place;
  const std::size_t knot = place.knot;
  ASSERT_TRUE(control.replace_rest(rest_from(knot, 0.0), place));
  EXPECT_NEAR((step(control).tau - sample_plan(plan_, 0.023).tau).norm(), 0.0, 1e-9);
}

/// From any moment on.
TEST_F(ControlTickRestTest, ALandingGoesOnByTheNewRestAfterItsImpact) {
  ControlTick control = standing();
  step(control);
  control.offer(plan_);
  run_to(control, RobotPhase::flight);
  for (int i = 0; i < 80; ++i) step(control);  // past the share in which contact is ignored
  state_.contact = {true, true};
  step(control);
  ASSERT_EQ(control.phase(), RobotPhase::landing);
  EXPECT_FALSE(control.rest_question(0.010)) << "its impact is not over";
  for (int i = 0; i < 20; ++i) step(control);
  const double now = control.status().plan_time + testing::kActuationDelay;
  const auto question = control.rest_question(0.010);
  ASSERT_TRUE(question);
  const auto& [knot, begin] = question->place;
  EXPECT_NEAR(begin, now + 0.010, 1e-9);
  EXPECT_LT(plan_.knots[knot - 1].time, begin);
  EXPECT_GT(plan_.knots[knot].time, begin);
  core::JumpPlan rest = rest_from(knot - 1, 0.1);
  rest.duration = 0.3;
  ASSERT_TRUE(control.replace_rest(rest, question->place));
  EXPECT_EQ(control.plan().knot_count, plan_.knot_count + 1);
  EXPECT_NEAR(control.plan().knots[knot].time, begin, 1e-12);
  EXPECT_NEAR(control.plan().knots[knot - 1].dt, begin - plan_.knots[knot - 1].time, 1e-12);
  EXPECT_NEAR(control.plan().duration, begin + 0.3, 1e-12);
  EXPECT_EQ(control.plan().touchdown_time, plan_.touchdown_time);
}

}  // namespace
}  // namespace hopscotch::control
