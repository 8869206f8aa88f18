#include "apps/plan_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "model/gravity.hpp"
#include "tests/unit/apps/planned_trial.hpp"

namespace hopscotch::apps {
namespace {

using Json = nlohmann::json;

/// What `plan --fly --json --out` would write of a jump with the shipped tuning, knots included.
Json trajectory_of(double distance, double height) {
  const FlightTrial trial = testing::planned_trial({.distance = distance, .height = height});
  PlanContext context;
  context.flown = fly(trial);
  return Json::parse(plan_trajectory_json(trial.plan, context));
}

class PlannedFlight : public ::testing::TestWithParam<std::pair<double, double>> {
 protected:
  PlannedFlight() : json_(trajectory_of(GetParam().first, GetParam().second)) {}

  [[nodiscard]] double planned() const { return json_["flight_s"].get<double>(); }

  Json json_;
};

TEST_P(PlannedFlight, LastsFromTheKnotOfLiftoffToThatOfTouchdown) {
  double in_air = 0.0;
  for (const Json& knot : json_["knots"]) {
    if (knot["phase"] == "flight") in_air += knot["dt_s"].get<double>();
  }
  EXPECT_NEAR(planned(), in_air, 1e-9);
}

TEST_P(PlannedFlight, LastsAsLongAsTheCoMFlies) {
  const Json* first = nullptr;
  const Json* after = nullptr;
  for (const Json& knot : json_["knots"]) {
    if (first == nullptr && knot["phase"] == "flight") first = &knot;
    if (after == nullptr && knot["phase"] == "landing") after = &knot;
  }
  ASSERT_TRUE(first != nullptr && after != nullptr);
  const double rise = (*after)["p_WG_m"][2].get<double>() - (*first)["p_WG_m"][2].get<double>();
  const double speed = json_["takeoff"]["speed_z_mps"].get<double>();
  const double time = planned();
  EXPECT_NEAR(rise, speed * time - 0.5 * model::kGravity * time * time, 2e-3);
}

TEST_P(PlannedFlight, IsFlownAsLongAsItSays) {
  constexpr double kEarlyOrLate = 0.012;  // [s]
  EXPECT_NEAR(json_["flown"]["flight_s"].get<double>(), planned(), kEarlyOrLate);
  EXPECT_GT(planned(), 0.15);
}

INSTANTIATE_TEST_SUITE_P(Jumps, PlannedFlight,
                         ::testing::Values(std::pair{0.35, 0.0}, std::pair{0.40, 0.20},
                                           std::pair{0.42, -0.15}));

}  // namespace
}  // namespace hopscotch::apps
