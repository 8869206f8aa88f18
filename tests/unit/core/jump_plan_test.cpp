#include "core/jump_plan.hpp"

#include <gtest/gtest.h>

#include <set>

namespace hopscotch::core {
namespace {

TEST(Certificate, BindingEntryHasTheSmallestMargin) {
  Certificate certificate;
  certificate.entries[0] = {.name = "hip torque", .margin = 0.4, .time = 0.1};
  certificate.entries[1] = {.name = "knee power", .margin = -0.1, .time = 0.2};
  certificate.entries[2] = {.name = "friction", .margin = 0.2, .time = 0.3};
  certificate.count = 3;
  EXPECT_EQ(certificate.binding().name, "knee power");
}

TEST(Certificate, BindingLooksOnlyAtFilledEntries) {
  Certificate certificate;
  certificate.entries[0] = {.name = "hip torque", .margin = 0.4, .time = 0.1};
  certificate.entries[1] = {.name = "left over", .margin = -1.0, .time = 0.2};
  certificate.count = 1;
  EXPECT_EQ(certificate.binding().name, "hip torque");
}

TEST(JumpPlan, NamesOfPhasesAndStatesAreDistinct) {
  EXPECT_EQ((std::set{jump_phase_name(JumpPhase::takeoff), jump_phase_name(JumpPhase::flight),
                      jump_phase_name(JumpPhase::landing)})
                .size(),
            3U);
  EXPECT_EQ(
      (std::set{plan_status_name(PlanStatus::solved), plan_status_name(PlanStatus::iteration_limit),
                plan_status_name(PlanStatus::infeasible), plan_status_name(PlanStatus::bad_input)})
          .size(),
      4U);
}

TEST(JumpPlan, StartsUnusable) {
  const JumpPlan plan;
  EXPECT_EQ(plan.status, PlanStatus::bad_input);
  EXPECT_EQ(plan.knot_count, 0U);
  EXPECT_TRUE(std::isnan(plan.duration));
}

}  // namespace
}  // namespace hopscotch::core
