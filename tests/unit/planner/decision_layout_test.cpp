#include "planner/decision_layout.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "planner/constraint_block.hpp"

namespace hopscotch::planner {
namespace {

const DecisionLayout kLayout({.takeoff = 4, .flight = 3, .landing = 2});

TEST(DecisionLayout, GivesEachVariableOnePlace) {
  std::vector<int> uses(static_cast<std::size_t>(kLayout.size()), 0);
  const auto use = [&](int at, int count) {
    for (int i = 0; i < count; ++i) ++uses.at(static_cast<std::size_t>(at + i));
  };
  for (int k = 0; k <= 4; ++k) use(kLayout.takeoff(k), 6);
  for (int k = 1; k <= 3; ++k) use(kLayout.flight(k), 8);
  use(kLayout.touchdown_rates(), 3);
  for (int k = 1; k <= 2; ++k) use(kLayout.landing(k), 6);
  use(kLayout.liftoff_com(), 2);
  use(kLayout.liftoff_velocity(), 2);
  use(kLayout.momentum(), 1);
  use(kLayout.flight_step(), 1);
  use(kLayout.landing_step(), 1);
  for (const int count : uses) EXPECT_EQ(count, 1);
}

TEST(DecisionLayout, OfALandingAloneHasItsKnotsFromTheFirstOn) {
  const DecisionLayout landed({0, 0, 3});
  EXPECT_EQ(landed.landing(0), 0);
  EXPECT_EQ(landed.landing(3), 18);
  EXPECT_EQ(landed.landing_step(), 24);
  EXPECT_EQ(landed.size(), 25);
  const std::array<int, 13> at = landed.landing_step_variables(0);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(at[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(at[12], landed.landing_step());
}

TEST(DecisionLayout, FlightStartsWithTheLastTakeoffKnotAndAFlatFoot) {
  const std::array<int, 17> at = kLayout.flight_step_variables(0);
  EXPECT_EQ(at[kShankPitch], kLayout.takeoff(4));
  EXPECT_EQ(at[kFootPitch], kNoVariable);
  EXPECT_EQ(at[kFlightDof + kShankPitch], kLayout.takeoff(4) + 3);
  EXPECT_EQ(at[kFlightDof + kFootPitch], kNoVariable);
  EXPECT_EQ(at[8], kLayout.flight(1));
  EXPECT_EQ(at[16], kLayout.flight_step());
}

TEST(DecisionLayout, LandingStartsWithThePitchesOfTheLastFlightKnotAndItsOwnRates) {
  const std::array<int, 13> at = kLayout.landing_step_variables(0);
  EXPECT_EQ(at[0], kLayout.flight(3));
  EXPECT_EQ(at[3], kLayout.touchdown_rates());
  EXPECT_EQ(at[6], kLayout.landing(1));
  EXPECT_EQ(at[12], kLayout.landing_step());
}

TEST(DecisionLayout, CoordinatesAndLinksAreInverse) {
  const model::LinkArray<double> link{0.1, -0.8, 0.7, 0.2};
  const std::array<double, 4> y = coordinates_from_links(link);
  const model::LinkArray<double> back = links_from_coordinates(y[0], y[1], y[2], y[3]);
  for (std::size_t j = 0; j < 4; ++j) EXPECT_DOUBLE_EQ(back[j], link[j]);
}

}  // namespace
}  // namespace hopscotch::planner
