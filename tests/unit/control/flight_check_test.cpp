#include "control/flight_check.hpp"

#include <gtest/gtest.h>

#include "tests/unit/control/estimator_fixture.hpp"

namespace hopscotch::control {
namespace {

constexpr double kTick = 0.001;

/// A trunk that rises at a true speed over soles that stand still, and is believed to rise at
/// another one.
class FlightCheckTest : public ::testing::Test {
 protected:
  std::optional<FlightError> feed(int ticks, int standing, double true_speed, double error) {
    std::optional<FlightError> found;
    for (int i = 0; i < ticks; ++i) {
      below_[0] -= true_speed * kTick;
      below_[1] -= (true_speed + sinking_) * kTick;
      const auto answer = check_.update(
          {.standing = standing, .below = below_, .rise_speed = true_speed + error}, kTick);
      if (answer) {
        ++answers_;
        found = answer;
      }
    }
    return found;
  }

  FlightCheck check_{testing::estimator_config().flight_check};
  std::array<double, core::kLegs> below_{-0.5, -0.5};
  double sinking_ = 0.0;  ///< Of the right sole, slower than the trunk rises over the left [m/s].
  int answers_ = 0;
};

TEST_F(FlightCheckTest, ASpeedThatFitsTheSolesIsNoError) {
  feed(300, 0, -1.0, 0.0);
  EXPECT_FALSE(feed(200, 2, -0.4, 0.01).has_value());
}

TEST_F(FlightCheckTest, ASpeedThatDoesNotIsToldOnceWithItsFlight) {
  feed(300, 0, -1.0, 0.2);
  const auto error = feed(500, 2, -0.4, 0.2);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(answers_, 1);
  EXPECT_NEAR(error->rise_speed, 0.2, 1e-6);
  EXPECT_NEAR(error->flown, 0.3, 1e-6);
  EXPECT_NEAR(error->stood, 0.04, 0.002);
}

TEST_F(FlightCheckTest, BeforeAFlightThereIsNothingToTell) {
  EXPECT_FALSE(feed(500, 2, 0.0, 0.3).has_value());
}

TEST_F(FlightCheckTest, OneSoleIsNotEnough) {
  feed(300, 0, -1.0, 0.2);
  EXPECT_FALSE(feed(100, 1, -0.4, 0.2).has_value());
  EXPECT_TRUE(feed(50, 2, -0.4, 0.2).has_value());
}

TEST_F(FlightCheckTest, ASoleThatMovesIsNoErrorOfTheFlight) {
  feed(300, 0, -1.0, 0.0);
  sinking_ = 0.3;
  EXPECT_FALSE(feed(200, 2, -0.4, 0.0).has_value());
}

TEST_F(FlightCheckTest, AnErrorThatPassesIsNoneOfTheFlight) {
  feed(300, 0, -1.0, 0.0);
  EXPECT_FALSE(feed(31, 2, -0.4, 0.3).has_value());
  EXPECT_FALSE(feed(200, 2, -0.4, 0.0).has_value());
}

TEST_F(FlightCheckTest, ABounceBelongsToTheFlight) {
  feed(300, 0, -1.0, 0.2);
  feed(10, 2, -0.4, 0.2);
  feed(5, 0, 0.2, 0.2);
  const auto error = feed(100, 2, -0.4, 0.2);
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->flown, 0.315, 1e-6);
}

TEST_F(FlightCheckTest, SolesThatStandLateTellNothing) {
  feed(300, 0, -1.0, 0.2);
  feed(300, 1, -0.4, 0.2);
  EXPECT_FALSE(feed(100, 2, -0.4, 0.2).has_value());
}

}  // namespace
}  // namespace hopscotch::control
