#include "footstep/reachability.hpp"

#include <gtest/gtest.h>

#include "core/robot_state.hpp"

namespace hopscotch::footstep {
namespace {

using core::Reason;

ReachConfig table() {
  ReachConfig config;
  config.height = {-0.30, 0.0, 0.20};
  config.distance_min = {0.30, 0.10, 0.20};
  config.distance_max = {0.40, 0.60, 0.40};
  config.takeoff_edge_max = {0.12, 1.0, 1.0};
  config.past_edge_min = {0.24, 0.10, 0.10};
  config.drop_min = 0.05;
  return config;
}

TEST(Reachability, IsLinearBetweenTheRowsOfTheTable) {
  const Reach reach = reach_at(table(), 0.10);
  EXPECT_NEAR(reach.distance_min, 0.15, 1e-12);
  EXPECT_NEAR(reach.distance_max, 0.50, 1e-12);
  EXPECT_NEAR(reach_at(table(), -0.15).takeoff_edge_max, 0.56, 1e-12);
}

TEST(Reachability, EndsOfTheTableHoldBeyondIt) {
  EXPECT_DOUBLE_EQ(reach_at(table(), 0.9).distance_max, 0.40);
  EXPECT_DOUBLE_EQ(reach_at(table(), -0.9).distance_min, 0.30);
}

TEST(Reachability, HeightsBeyondTheTableAreRefusedByName) {
  EXPECT_EQ(reach_verdict(table(), {.distance = 0.3, .height = 0.21}), Reason::step_too_high);
  EXPECT_EQ(reach_verdict(table(), {.distance = 0.3, .height = -0.31}), Reason::step_too_low);
}

TEST(Reachability, DistancesOutsideTheWindowAreOutOfReach) {
  EXPECT_EQ(reach_verdict(table(), {.distance = 0.35, .height = 0.0}), Reason::none);
  EXPECT_EQ(reach_verdict(table(), {.distance = 0.05, .height = 0.0}), Reason::out_of_reach);
  EXPECT_EQ(reach_verdict(table(), {.distance = 0.65, .height = 0.0}), Reason::out_of_reach);
  EXPECT_EQ(reach_verdict(table(), {.distance = core::kNaN, .height = 0.0}), Reason::out_of_reach);
}

TEST(Reachability, JumpDownNeedsToesNearTheEdge) {
  const Leap near{.distance = 0.35, .height = -0.25, .takeoff_edge = 0.11};
  const Leap far{.distance = 0.35, .height = -0.25, .takeoff_edge = 0.35};
  EXPECT_EQ(reach_verdict(table(), near), Reason::none);
  EXPECT_EQ(reach_verdict(table(), far), Reason::out_of_reach);
}

TEST(Reachability, JumpDownEndsClearOfTheEdge) {
  const Leap clear{.distance = 0.36, .height = -0.30, .takeoff_edge = 0.11};
  const Leap close{.distance = 0.34, .height = -0.30, .takeoff_edge = 0.11};
  EXPECT_EQ(reach_verdict(table(), clear), Reason::none);
  EXPECT_EQ(reach_verdict(table(), close), Reason::out_of_reach);
}

TEST(Reachability, SmallDropsDoNotCareForTheEdge) {
  const Leap small{.distance = 0.35, .height = -0.04, .takeoff_edge = 5.0};
  EXPECT_EQ(reach_verdict(table(), small), Reason::none);
}

TEST(Reachability, ExtremesOfTheTable) {
  EXPECT_DOUBLE_EQ(longest_reach(table()), 0.60);
  EXPECT_DOUBLE_EQ(shortest_reach(table()), 0.10);
}

}  // namespace
}  // namespace hopscotch::footstep
