#include "planner/formulation.hpp"

#include <gtest/gtest.h>

#include "model/kinematics.hpp"
#include "planner/leg_chain.hpp"
#include "planner/leg_statics.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::hector;
using testing_support::request;
using testing_support::shipped_config;
using testing_support::shipped_model;

constexpr double kRounding = 1e-9;  // [N·m], [m]

TEST(LegStatics, EqualTheDynamicsOfMasslessLegsAtRest) {
  model::PlanarChain chain = shipped_model().dynamics.chain();
  for (model::PlanarLink* link : {&chain.foot, &chain.shank, &chain.thigh}) {
    link->mass = link->inertia = 0.0;
  }
  const model::PlanarDynamics dynamics(chain);
  const model::LinkArray<double> posture{0.0, -0.7, 0.6, 0.2};
  const model::StanceLoads<double> loads = dynamics.stance_loads(posture, {}, {});
  const model::PlanarJoints<double> tau = static_torques(chain, posture, loads.force, loads.moment);
  EXPECT_NEAR(tau.hip, loads.tau.hip, kRounding);
  EXPECT_NEAR(tau.knee, loads.tau.knee, kRounding);
  EXPECT_NEAR(tau.ankle, loads.tau.ankle, kRounding);
}

TEST(LegChain, AgreesWithTheModelsKinematics) {
  for (const core::Leg leg : core::kAllLegs) {
    const LegChain chain(hector(), leg);
    const std::array<double, 5> q{0.1, -0.05, 0.6, -1.1, 0.45};
    const core::LegVector joints = Eigen::Map<const core::LegVector>(q.data());
    const model::LegPoses poses = model::leg_poses(hector(), leg, joints);
    const Vector3<double> sole = chain.sole_centre(q);
    const Vector3<double> toe = chain.toe_direction(q);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(sole[static_cast<std::size_t>(i)], poses.X_BF.translation()(i), kRounding);
      EXPECT_NEAR(toe[static_cast<std::size_t>(i)], poses.X_BF.linear()(i, 0), kRounding);
    }
    const Eigen::Vector<double, 6> effort{20.0, -5.0, 120.0, 0.5, 3.0, -1.0};
    const std::array<double, 5> tau =
        chain.torques(q, Vector3<double>{20.0, -5.0, 120.0}, Vector3<double>{0.5, 3.0, -1.0});
    const core::LegVector expected =
        -model::sole_jacobian(hector(), leg, joints).transpose() * effort;
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(tau[static_cast<std::size_t>(i)], expected(i), kRounding);
    }
  }
}

TEST(Formulation, NamesAreUnderstood) {
  for (const Formulation each : {Formulation::variable, Formulation::paper, Formulation::full,
                                 Formulation::kinodynamic, Formulation::single_body}) {
    EXPECT_EQ(formulation_from(formulation_name(each)), each);
  }
  EXPECT_EQ(formulation_from("quantum"), std::nullopt);
}

class Compared : public testing::TestWithParam<Formulation> {};

TEST_P(Compared, SolvesALeapAndEndsAtRestOnTheTarget) {
  const PlanarModel model = shipped_model();
  const PlanarTask task = testing_support::task(model, 0.40, 0.0);
  const FormulatedJump jump = solve_formulation(GetParam(), model, task);
  ASSERT_EQ(jump.outcome.status, SolveStatus::solved);
  EXPECT_LT(jump.outcome.violation, 1e-3);
  EXPECT_GT(jump.rows, 500);
  const PlanarMotion& motion = jump.motion;
  EXPECT_LT(motion.liftoff_time, motion.touchdown_time);
  const PlanarInstant end = instant(model, motion, motion.knots.back(), 0.0);
  EXPECT_NEAR(end.ankle.x, motion.target_ankle.x, 2e-3);
  EXPECT_NEAR(end.ankle.z, motion.target_ankle.z, 2e-3);
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    EXPECT_NEAR(end.links.pitch[j], task.final_posture[j], 0.02);
    EXPECT_NEAR(end.links.rate[j], 0.0, 1e-6);
  }
}

TEST_P(Compared, CarriesTheWeightOverTheWholeJump) {
  const PlanarModel model = shipped_model();
  const PlanarTask task = testing_support::task(model, 0.25, 0.0);
  const FormulatedJump jump = solve_formulation(GetParam(), model, task);
  ASSERT_EQ(jump.outcome.status, SolveStatus::solved);
  // From rest to rest: the impulse of the ground is weight times time, except for a touchdown
  // between two steps, which has an impulse of its own, and masses that a formulation leaves out.
  double impulse = 0.0;
  for (const PlanarKnot& knot : jump.motion.knots) {
    impulse += knot.dt * instant(model, jump.motion, knot, 0.5 * knot.dt).force.z;
  }
  const double weight = model.dynamics.chain().total_mass() * model::kGravity;
  EXPECT_NEAR(impulse / (weight * jump.motion.knots.back().time), 1.0, 0.15);
}

INSTANTIATE_TEST_SUITE_P(All, Compared,
                         testing::Values(Formulation::paper, Formulation::full,
                                         Formulation::kinodynamic, Formulation::single_body),
                         [](const auto& test) {
                           return std::string(formulation_name(test.param));
                         });

TEST(Formulation, CertificateSaysWhatExactDynamicsMakeOfThePromise) {
  JumpPlanner planner(shipped_config(), hector());
  PlanRequest asked = request(0.40, 0.0);
  const core::Result<core::JumpPlan> exact = planner.plan(asked);
  asked.formulation = Formulation::paper;
  const core::Result<core::JumpPlan> paper = planner.plan(asked);
  ASSERT_TRUE(exact && paper);
  EXPECT_LT(exact->certificate.dense_max_violation, 1e-3);
  EXPECT_GT(paper->certificate.dense_max_violation, 0.05);
}

TEST(Formulation, ComparisonsJumpStraightAheadOnly) {
  JumpPlanner planner(shipped_config(), hector());
  PlanRequest aside = request(0.35, 0.0);
  for (Eigen::Isometry3d& sole : aside.target.X_WF) sole.translation().y() += 0.05;
  aside.formulation = Formulation::single_body;
  const core::Result<core::JumpPlan> plan = planner.plan(aside);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().reason, core::Reason::target_malformed);
}

}  // namespace
}  // namespace hopscotch::planner
