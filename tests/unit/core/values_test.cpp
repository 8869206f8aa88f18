// What freshly made values hold: measured numbers are NaN, so that a forgotten write is noticed,
// and commands are harmless.
#include <gtest/gtest.h>

#include <type_traits>

#include "core/contact_wrenches.hpp"
#include "core/control_reference.hpp"
#include "core/depth_source.hpp"
#include "core/joint_command.hpp"
#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/operator_command.hpp"
#include "core/plant.hpp"
#include "core/robot_state.hpp"
#include "core/sensor_readings.hpp"

namespace hopscotch::core {
namespace {

TEST(Values, MeasurementsStartAsNotANumber) {
  const RobotState state;
  EXPECT_TRUE(state.p_WB.array().isNaN().all());
  EXPECT_TRUE(state.R_WB.array().isNaN().all());
  EXPECT_TRUE(state.q.array().isNaN().all());
  const SensorReadings readings;
  EXPECT_TRUE(readings.tau.array().isNaN().all());
  EXPECT_TRUE(readings.f_B.array().isNaN().all());
}

TEST(Values, FreshCommandGivesNoTorque) {
  const JointCommand command;
  EXPECT_EQ(command.mode, DriveMode::idle);
  EXPECT_TRUE(command.kp.isZero(0.0));
  EXPECT_TRUE(command.kd.isZero(0.0));
  EXPECT_TRUE(command.tau.isZero(0.0));
}

TEST(Values, FreshWrenchesAreZeroAndNoFootTouches) {
  for (const Wrench& wrench : ContactWrenches{}) {
    EXPECT_TRUE(wrench.force.isZero(0.0));
    EXPECT_TRUE(wrench.moment.isZero(0.0));
  }
  for (const bool contact : RobotState{}.contact) EXPECT_FALSE(contact);
}

TEST(Values, FreshOperatorCommandAsksForNothing) {
  const OperatorCommand command;
  EXPECT_EQ(command.mode, ModeRequest::none);
  EXPECT_FALSE(command.target.has_value());
}

TEST(Values, FreshChoiceHasNoTarget) {
  const TargetChoice choice;
  EXPECT_FALSE(choice.target.has_value());
  EXPECT_EQ(choice.ranked_count, 0U);
  EXPECT_EQ(choice.rejected_count, 0U);
}

TEST(Values, HotValuesOwnNoHeap) {
  EXPECT_TRUE(std::is_trivially_destructible_v<RobotState>);
  EXPECT_TRUE(std::is_trivially_destructible_v<SensorReadings>);
  EXPECT_TRUE(std::is_trivially_destructible_v<JointCommand>);
  EXPECT_TRUE(std::is_trivially_destructible_v<ControlReference>);
  EXPECT_TRUE(std::is_trivially_destructible_v<JumpPlan>);
}

TEST(Values, SourcesOfTargetsHaveTheNamesOfTheResultFile) {
  EXPECT_EQ(target_source_name(TargetSource::perception), "perception");
  EXPECT_EQ(target_source_name(TargetSource::truth), "truth");
  EXPECT_EQ(target_source_name(TargetSource::operator_override), "operator");
}

}  // namespace
}  // namespace hopscotch::core
