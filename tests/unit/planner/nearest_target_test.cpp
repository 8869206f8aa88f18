#include "planner/nearest_target.hpp"

#include <gtest/gtest.h>

#include "planner/slot_names.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::hector;
using testing_support::request;
using testing_support::shipped_config;

TEST(NearestTarget, OfAJumpThatIsTooFarIsAJumpThatPlans) {
  JumpPlanner planner(shipped_config(), hector());
  const StepRequest far{.distance = 0.85, .edge = 0.7};
  const PlanRequest asked = request(0.85, 0.0);
  ASSERT_FALSE(planner.plan(asked));
  EXPECT_FALSE(planner.obstacle().empty());
  const std::optional<NearestTarget> nearest = nearest_target(planner, asked, far, hector());
  ASSERT_TRUE(nearest);
  EXPECT_GT(nearest->step.distance, 0.5);
  EXPECT_LT(nearest->step.distance, 0.85);
  EXPECT_FALSE(nearest->binding.name.empty());
  PlanRequest again = asked;
  again.target = step_target(nearest->step, hector());
  EXPECT_TRUE(planner.plan(again));
}

TEST(NearestTarget, OfAStepThatIsTooHighIsLower) {
  JumpPlanner planner(shipped_config(), hector());
  const StepRequest high{.distance = 0.40, .height = 0.35, .edge = 0.28};
  const std::optional<NearestTarget> nearest =
      nearest_target(planner, request(0.40, 0.35), high, hector());
  ASSERT_TRUE(nearest);
  EXPECT_GT(nearest->step.height, 0.15);
  EXPECT_LT(nearest->step.height, 0.35);
}

TEST(NearestTarget, IsNoneForNumbersThatAreNone) {
  JumpPlanner planner(shipped_config(), hector());
  const StepRequest broken{.distance = core::kNaN, .edge = 0.1};
  EXPECT_FALSE(nearest_target(planner, request(0.4, 0.0), broken, hector()));
}

TEST(SlotNames, NameEveryInequality) {
  const ChainLayout layout{DecisionLayout(shipped_config().steps)};
  for (int slot = 0; slot < layout.slots(); ++slot) {
    EXPECT_FALSE(slot_name(layout, slot).empty()) << slot;
  }
  EXPECT_EQ(slot_name(layout, layout.takeoff_rows(3) + 4), "knee torque");
  EXPECT_EQ(slot_name(layout, layout.landing_rows(2) + 13), "friction");
  EXPECT_EQ(slot_name(layout, layout.clearance(1) + 1), "heel clearance");
  EXPECT_EQ(slot_name(layout, layout.touchdown_speeds()), "touchdown speed along");
  EXPECT_EQ(slot_name(layout, layout.flight_joints(0) + 3), "ankle range");
  const DecisionLayout& decision = layout.decision();
  EXPECT_EQ(slot_name(layout, layout.variable(decision.takeoff(4) + 1)), "knee range");
  EXPECT_EQ(slot_name(layout, layout.variable(decision.flight(2) + 6)), "trunk rate");
  EXPECT_EQ(slot_name(layout, layout.variable(decision.flight_step())), "flight time");
}

}  // namespace
}  // namespace hopscotch::planner
