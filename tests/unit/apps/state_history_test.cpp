#include "apps/state_history.hpp"

#include <gtest/gtest.h>

#include "model/kinematics.hpp"

namespace hopscotch::apps {
namespace {

core::RobotState state_at(double time) {
  core::RobotState state;
  state.stamp = core::Stamp::from_seconds(time);
  state.p_WB = {2.0 * time, 0.0, 0.5};
  state.R_WB = model::rotation_from_rpy({0.0, time, 0.0});
  state.v_WB = {2.0, 0.0, 0.0};
  state.w_WB = {0.0, 1.0, 0.0};
  state.q.setConstant(time);
  state.dq.setConstant(1.0);
  return state;
}

TEST(StateHistory, StoredStatesComeBackExactly) {
  StateHistory history;
  for (int i = 0; i < 100; ++i) history.add(state_at(0.001 * i));
  const auto state = history.at(core::Stamp::from_seconds(0.042));
  ASSERT_TRUE(state.has_value());
  EXPECT_EQ(state->q, state_at(0.042).q);
}

TEST(StateHistory, BetweenTwoStatesIsInterpolated) {
  StateHistory history;
  history.add(state_at(0.0));
  history.add(state_at(0.1));
  const auto state = history.at(core::Stamp::from_seconds(0.025));
  ASSERT_TRUE(state.has_value());
  EXPECT_NEAR(state->p_WB.x(), 0.05, 1e-12);
  EXPECT_NEAR((state->R_WB - state_at(0.025).R_WB).norm(), 0.0, 1e-12);
}

TEST(StateHistory, NothingIsExtrapolated) {
  StateHistory history;
  EXPECT_FALSE(history.at({}).has_value());
  for (int i = 10; i < 20; ++i) history.add(state_at(0.001 * i));
  EXPECT_FALSE(history.at(core::Stamp::from_seconds(0.0099)).has_value());
  EXPECT_FALSE(history.at(core::Stamp::from_seconds(0.0191)).has_value());
}

TEST(StateHistory, ForgetsTheOldestFirst) {
  StateHistory history;
  for (int i = 0; i < 2000; ++i) history.add(state_at(0.001 * i));
  EXPECT_FALSE(history.at(core::Stamp::from_seconds(1.0)).has_value());
  EXPECT_NEAR(history.at(core::Stamp::from_seconds(1.6))->q[0], 1.6, 1e-9);
}

}  // namespace
}  // namespace hopscotch::apps
