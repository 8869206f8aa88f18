#include "planner/forward_dynamics.hpp"

#include <gtest/gtest.h>

#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

constexpr double kRounding = 1e-7;  // of accelerations up to 1e2, through a 4x4 solve

class ForwardDynamics : public testing::Test {
 protected:
  PlanarModel model_ = testing_support::shipped_model();
  LinkState links_{{0.1, -0.8, 0.7, 0.2}, {1.0, 3.0, -4.0, 2.0}};
  model::PlanarJoints<double> tau_{12.0, 35.0, -8.0};
};

TEST_F(ForwardDynamics, InvertsTheStanceDynamics) {
  LinkState standing = links_;
  standing.pitch[model::kFoot] = standing.rate[model::kFoot] = 0.0;
  const model::LinkArray<double> u = stance_acceleration(model_.dynamics, standing, tau_);
  EXPECT_EQ(u[model::kFoot], 0.0);
  const model::PlanarJoints<double> back =
      model_.dynamics.stance_loads(standing.pitch, standing.rate, u).tau;
  EXPECT_NEAR(back.hip, tau_.hip, kRounding);
  EXPECT_NEAR(back.knee, tau_.knee, kRounding);
  EXPECT_NEAR(back.ankle, tau_.ankle, kRounding);
}

TEST_F(ForwardDynamics, InvertsTheFlightDynamicsAndKeepsTheMomentum) {
  const model::LinkArray<double> u = flight_acceleration(model_.dynamics, links_, tau_);
  const model::PlanarJoints<double> back =
      model_.dynamics.flight_torques(links_.pitch, links_.rate, u);
  EXPECT_NEAR(back.hip, tau_.hip, kRounding);
  EXPECT_NEAR(back.knee, tau_.knee, kRounding);
  EXPECT_NEAR(back.ankle, tau_.ankle, kRounding);
  EXPECT_NEAR(model_.dynamics.momentum_rate(links_.pitch, links_.rate, u), 0.0, kRounding);
}

TEST_F(ForwardDynamics, IntegratedFlightKeepsTheAngularMomentum) {
  const double before = model_.dynamics.centroidal_momentum(links_.pitch, links_.rate);
  const LinkState after =
      integrate(model_.dynamics, core::JumpPhase::flight, links_, {0.0, 0.0, 0.0}, 0.1);
  EXPECT_NEAR(model_.dynamics.centroidal_momentum(after.pitch, after.rate), before, 1e-4);
}

TEST_F(ForwardDynamics, HoldingTorquesHold) {
  const PlanarTask task = testing_support::task(model_, 0.4, 0.0);
  const model::PlanarJoints<double> hold =
      model_.dynamics.stance_loads(task.start.pitch, {}, {}).tau;
  const LinkState after =
      integrate(model_.dynamics, core::JumpPhase::takeoff, task.start, hold, 0.02);
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    EXPECT_NEAR(after.pitch[j], task.start.pitch[j], 1e-9);
  }
}

}  // namespace
}  // namespace hopscotch::planner
