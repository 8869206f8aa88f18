#include "footstep/step_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/footstep/known_course.hpp"

namespace hopscotch::footstep {
namespace {

using core::CellState;
using core::Reason;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Foothold safe_place(double x, double height = 0.0) {
  Foothold foothold;
  foothold.placement.x = x;
  foothold.height = height;
  foothold.supported = true;
  foothold.toe_margin = kMarginSearch;
  foothold.heel_margin = kMarginSearch;
  foothold.safe_probability = 1.0;
  return foothold;
}

class StepGraphTest : public ::testing::Test {
 protected:
  StepGraphTest() {
    profile_.bounded.fill(true);
    profile_.profile.state.fill(CellState::observed);
  }
  StepRules rules(double goal_x = kInfinity) const {
    return {.config = config_,
            .profile = profile_,
            .mapped = profile_,
            .half_length = 0.075,
            .goal_x = goal_x};
  }

  FootstepConfig config_ = test::footstep_config();
  BoundedProfile profile_;
  Takeoff here_{.x = 0.0, .height = 0.0, .edge = kInfinity};
};

TEST_F(StepGraphTest, NominalJumpIsAllowedAndCheapest) {
  const double nominal = config_.preference.nominal_distance;
  EXPECT_EQ(step_verdict(rules(), here_, safe_place(nominal)), Reason::none);
  const double best = step_cost(rules(), here_, safe_place(nominal));
  EXPECT_GT(step_cost(rules(), here_, safe_place(nominal - 0.05)), best);
  EXPECT_GT(step_cost(rules(), here_, safe_place(nominal + 0.05)), best);
}

TEST_F(StepGraphTest, DoubtAboutTheHeightAsksForMoreRoomBesideTheSoles) {
  Foothold central = safe_place(config_.preference.nominal_distance - 0.04);
  Foothold near_edge = safe_place(config_.preference.nominal_distance);
  central.toe_margin = config_.preference.margin_wanted + 0.04;
  near_edge.toe_margin = config_.preference.margin_wanted;
  EXPECT_LT(step_cost(rules(), here_, near_edge), step_cost(rules(), here_, central));
  StepRules doubtful = rules();
  doubtful.height_doubt = 0.04;
  EXPECT_GT(step_cost(doubtful, here_, near_edge), step_cost(doubtful, here_, central));
}

TEST_F(StepGraphTest, UnboundedGroundOnTheWayForbidsTheJump) {
  profile_.bounded[static_cast<std::size_t>(core::TerrainProfile::sample(0.25))] = false;
  EXPECT_EQ(step_verdict(rules(), here_, safe_place(0.4)), Reason::terrain_unseen);
}

TEST_F(StepGraphTest, HurdleOnTheWayForbidsTheJump) {
  profile_.profile.upper[static_cast<std::size_t>(core::TerrainProfile::sample(0.25))] =
      config_.reach.hurdle_max + 0.01;
  EXPECT_EQ(step_verdict(rules(), here_, safe_place(0.4)), Reason::step_too_high);
  EXPECT_EQ(step_verdict(rules(), here_, safe_place(0.4, 0.05)), Reason::none)
      << "it is allowed to stand out that much above the landing";
}

TEST_F(StepGraphTest, ThingThatHangsTooLowForbidsTheJumpBelowIt) {
  const auto verdict_below = [&](double x, double bottom, double landing_height) {
    const Overhead thing{.x = x, .bottom = bottom};
    StepRules below = rules();
    below.overhead = {&thing, 1};
    return step_verdict(below, here_, safe_place(0.4, landing_height));
  };
  EXPECT_EQ(verdict_below(0.25, 0.50, 0.0), Reason::no_safe_target);
  EXPECT_EQ(verdict_below(0.25, config_.reach.head_room + 0.01, 0.0), Reason::none);
  EXPECT_EQ(verdict_below(0.25, config_.reach.head_room + 0.01, 0.10), Reason::no_safe_target)
      << "room is needed over the higher ground";
  EXPECT_EQ(verdict_below(0.60, 0.50, 0.0), Reason::none) << "it hangs behind the landing";
  EXPECT_EQ(verdict_below(0.25, 0.02, 0.0), Reason::none) << "an edge of the ground";
}

TEST_F(StepGraphTest, EdgesCostWhatTheirMarginLacks) {
  Foothold near_edge = safe_place(0.4);
  near_edge.toe_margin = config_.preference.margin_wanted - 0.02;
  const double extra =
      step_cost(rules(), here_, near_edge) - step_cost(rules(), here_, safe_place(0.4));
  EXPECT_NEAR(extra, 0.02 * config_.preference.margin_weight, 1e-12);
}

TEST_F(StepGraphTest, LastJumpMayBeShortButNotOvershoot) {
  const StepRules to_goal = rules(0.30);
  const double at_goal = step_cost(to_goal, here_, safe_place(0.30));
  EXPECT_LT(at_goal, step_cost(to_goal, here_, safe_place(0.40)));
  EXPECT_NEAR(at_goal, config_.preference.step_cost, 1e-12);
}

TEST_F(StepGraphTest, TakeoffEdgeIsKnownOnlyWhenItWasFound) {
  EXPECT_EQ(takeoff_from(safe_place(0.4), 0.075).edge, kInfinity);
  Foothold near_edge = safe_place(0.4);
  near_edge.toe_margin = 0.05;
  EXPECT_NEAR(takeoff_from(near_edge, 0.075).edge, 0.525, 1e-12);
}

TEST_F(StepGraphTest, PlaceWithoutAWayOnIsADeadEnd) {
  const std::vector<double> costs = continuation_costs(rules(), {safe_place(0.3)});
  EXPECT_DOUBLE_EQ(costs[0], config_.preference.dead_end_cost);
}

TEST_F(StepGraphTest, PlaceBeforeUnseenGroundIsNoDeadEnd) {
  for (int i = core::TerrainProfile::sample(0.7); i < core::TerrainProfile::kSamples; ++i) {
    profile_.profile.state[static_cast<std::size_t>(i)] = CellState::never_seen;
  }
  const std::vector<double> costs = continuation_costs(rules(), {safe_place(0.4)});
  EXPECT_DOUBLE_EQ(costs[0], config_.preference.unseen_cost);
}

TEST_F(StepGraphTest, WayOnIsTheCheapestChainOfJumps) {
  const std::vector<Foothold> line{safe_place(0.4), safe_place(0.7), safe_place(0.8),
                                   safe_place(1.2)};
  const std::vector<double> costs = continuation_costs(rules(2.0), line);
  EXPECT_LT(costs[0], 0.2) << "0.4 m, 0.8 m, 1.2 m, each a nominal jump";
  EXPECT_GT(costs[1], costs[0]) << "from 0.7 m, only a long jump leads on";
}

TEST_F(StepGraphTest, NothingMoreIsOwedAtTheGoal) {
  const std::vector<double> costs = continuation_costs(rules(0.35), {safe_place(0.4)});
  EXPECT_DOUBLE_EQ(costs[0], 0.0);
}

TEST_F(StepGraphTest, UnsafePlacesAreNoWayOn) {
  Foothold unsafe = safe_place(0.4);
  unsafe.why = Reason::no_safe_target;
  const std::vector<double> costs = continuation_costs(rules(), {unsafe});
  EXPECT_TRUE(std::isinf(costs[0]));
}

}  // namespace
}  // namespace hopscotch::footstep
