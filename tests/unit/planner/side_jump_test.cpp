#include <gtest/gtest.h>

#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "model/knot_state.hpp"
#include "model/rigid_body.hpp"
#include "planner/leg_certificate.hpp"
#include "planner/lift_to_3d.hpp"
#include "tests/unit/planner/solved_jump.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::hector;
using testing_support::level_jump;
using testing_support::request;
using testing_support::shipped_config;
using testing_support::SolvedJump;

constexpr double kLateral = 0.08;
constexpr double kYaw = -0.2;
/// Legs are placed by iteration; the planar solution itself is good to 1e-3.
constexpr double kPlaced = 1e-6;
constexpr double kSolved = 1e-3;

const core::JumpPlan& side_jump() {
  static const core::JumpPlan plan = [] {
    core::JumpPlan out;
    const SolvedJump& jump = level_jump();
    out.target = step_target({.distance = 0.40, .edge = 0.28, .lateral = kLateral, .yaw = kYaw},
                             jump.model.robot);
    EXPECT_TRUE(lift_to_3d(jump.model, jump.motion, out.target, out));
    return out;
  }();
  return plan;
}

model::CompositeBody body_of(const core::JumpKnot& knot) {
  return model::composite_body(level_jump().model.robot, model::state_of(knot));
}

double heading_of(const Eigen::Isometry3d& X_WF) {
  return std::atan2(X_WF.linear()(1, 0), X_WF.linear()(0, 0));
}

TEST(SideJump, SolesStandAtTheStartAndOnTheTurnedTarget) {
  const core::JumpPlan& plan = side_jump();
  const auto start = model::sole_poses(level_jump().model.robot, model::state_of(plan.knots[0]));
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    const core::JumpKnot& knot = plan.knots[i];
    if (knot.phase == core::JumpPhase::flight) continue;
    const bool landed = knot.phase == core::JumpPhase::landing;
    const auto soles = model::sole_poses(level_jump().model.robot, model::state_of(knot));
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      const Eigen::Isometry3d& wanted = landed ? plan.target.X_WF[leg] : start[leg];
      EXPECT_LT((soles[leg].translation() - wanted.translation()).norm(), kSolved) << i;
      EXPECT_NEAR(heading_of(soles[leg]), heading_of(wanted), kPlaced) << i;
    }
  }
}

TEST(SideJump, CentreOfMassFliesAParabolaToTheSide) {
  const core::JumpPlan& plan = side_jump();
  const core::JumpKnot* first = nullptr;
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    const core::JumpKnot& knot = plan.knots[i];
    EXPECT_LT((body_of(knot).p_WG - knot.p_WG).norm(), kPlaced) << i;
    EXPECT_LT((body_of(knot).v_WG - knot.v_WG).norm(), 1e-4) << i;
    if (knot.phase != core::JumpPhase::flight) continue;
    if (first == nullptr) first = &knot;
    const double t = knot.time - first->time;
    Eigen::Vector3d expected = first->p_WG + t * first->v_WG;
    expected.z() -= 0.5 * model::kGravity * t * t;
    EXPECT_LT((knot.p_WG - expected).norm(), kPlaced) << i;
  }
  ASSERT_NE(first, nullptr);
  EXPECT_GT(first->v_WG.y(), 0.1);
}

TEST(SideJump, FlightKeepsTheVerticalAngularMomentum) {
  const core::JumpPlan& plan = side_jump();
  std::vector<double> momentum;
  double swing = 0.0;
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    if (plan.knots[i].phase != core::JumpPhase::flight) continue;
    momentum.push_back(body_of(plan.knots[i]).momentum_W.z());
    swing = std::max(swing, std::abs(plan.knots[i].w_WB.z()));
  }
  const auto [least, most] = std::minmax_element(momentum.begin(), momentum.end());
  constexpr double kTrunkInertia = 0.03;  // [kg·m^2]: what the trunk's swing would leave open
  EXPECT_LT(*most - *least, 0.1 * kTrunkInertia * swing);
}

TEST(SideJump, PlanContinuesThroughLiftoffAndTouchdown) {
  const core::JumpPlan& plan = side_jump();
  for (std::size_t i = 0; i + 1 < plan.knot_count; ++i) {
    const core::JumpKnot& a = plan.knots[i];
    const core::JumpKnot& b = plan.knots[i + 1];
    const double middle_yaw_rate = 0.5 * (a.w_WB.z() + b.w_WB.z());
    EXPECT_NEAR(b.rpy.z() - a.rpy.z(), a.dt * middle_yaw_rate, 2e-3) << i;
    EXPECT_NEAR(b.p_WG.y() - a.p_WG.y(), 0.5 * a.dt * (a.v_WG.y() + b.v_WG.y()), 1e-3) << i;
  }
  EXPECT_NEAR(plan.knots[plan.knot_count - 1].rpy.z(), kYaw, 1e-9);
  EXPECT_LT(plan.knots[plan.knot_count - 1].v_WG.norm(), kSolved);
}

/// Newton and Euler of the whole robot on the way to lift-off.
TEST(SideJump, WrenchesAccelerateAndTurnTheRobotAsPlanned) {
  const core::JumpPlan& plan = side_jump();
  const model::RobotParameters& robot = level_jump().model.robot;
  for (std::size_t i = 10; i + 1 < 25; ++i) {
    const core::JumpKnot& knot = plan.knots[i];
    const model::CompositeBody a = body_of(knot);
    const model::CompositeBody b = body_of(plan.knots[i + 1]);
    const auto soles = model::sole_poses(robot, model::state_of(knot));
    const Eigen::Vector3d centre = 0.5 * (a.p_WG + b.p_WG);
    Eigen::Vector3d force(0.0, 0.0, -a.mass * model::kGravity);
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      const core::Wrench& wrench = knot.wrenches[leg];
      force += wrench.force;
      moment += wrench.moment + (soles[leg].translation() - centre).cross(wrench.force);
    }
    constexpr double kForce = 4.0;   // [N] of up to 500
    constexpr double kMoment = 1.5;  // [N·m] of up to 40: mid-point rule, and the legs' own roll
    EXPECT_LT((force - a.mass * (b.v_WG - a.v_WG) / knot.dt).norm(), kForce) << i;
    EXPECT_LT((moment - (b.momentum_W - a.momentum_W) / knot.dt).norm(), kMoment) << i;
  }
}

TEST(SideJump, LegsAreJudgedOneByOne) {
  core::JumpPlan plan = side_jump();
  certify_legs(level_jump().model.robot, 0.5, plan);
  const auto margin = [&](std::string_view name) {
    for (std::size_t i = 0; i < plan.certificate.count; ++i) {
      if (plan.certificate.entries[i].name == name) return plan.certificate.entries[i].margin;
    }
    return core::kNaN;
  };
  EXPECT_GT(margin("lighter foot's load"), 0.0);
  EXPECT_LT(margin("lighter foot's load"), 1.0);
  EXPECT_GT(margin("hip roll and yaw motors"), 0.3);
  plan.certificate = {};
  model::RobotParameters weak = level_jump().model.robot;
  weak.motors[core::index(core::Joint::hip_roll)].torque_max *= 0.02;
  certify_legs(weak, 0.5, plan);
  EXPECT_EQ(plan.certificate.binding().name, "hip roll and yaw motors");
  EXPECT_LT(plan.certificate.binding().margin, 0.0);
}

struct SideCase {
  double distance, height, lateral, yaw;
};
class SideJumps : public testing::TestWithParam<SideCase> {};

TEST_P(SideJumps, ArePlannedAndCertified) {
  const SideCase& wanted = GetParam();
  PlanRequest side = request(wanted.distance, wanted.height);
  side.target = step_target({.distance = wanted.distance,
                             .height = wanted.height,
                             .edge = default_edge(wanted.distance, wanted.height),
                             .lateral = wanted.lateral,
                             .yaw = wanted.yaw},
                            hector());
  JumpPlanner planner(shipped_config(), hector());
  const core::Result<core::JumpPlan> plan = planner.plan(side);
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_GE(plan->certificate.binding().margin, -1e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Corners, SideJumps,
    testing::Values(SideCase{0.35, 0.0, 0.10, 0.0}, SideCase{0.35, 0.0, -0.10, 0.0},
                    SideCase{0.35, 0.0, 0.0, 0.2618}, SideCase{0.35, 0.0, 0.0, -0.2618},
                    SideCase{0.35, 0.0, 0.10, 0.2618}, SideCase{0.35, 0.10, 0.08, 0.2}));

}  // namespace
}  // namespace hopscotch::planner
