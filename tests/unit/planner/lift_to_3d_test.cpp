#include "planner/lift_to_3d.hpp"

#include <gtest/gtest.h>

#include "model/kinematics.hpp"
#include "model/knot_state.hpp"
#include "model/rigid_body.hpp"
#include "tests/unit/planner/solved_jump.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::level_jump;
using testing_support::SolvedJump;

constexpr double kHeading = 0.8;
/// The planar chain is the exact projection of the robot; contacts are solved to 1e-3.
constexpr double kExact = 1e-9;
constexpr double kSolved = 1e-3;

Eigen::Vector3d plan_origin() {
  return {1.0, -0.5, 0.2};
}

core::LandingTarget target(double heading) {
  core::LandingTarget target;
  target.p_WS = plan_origin();
  target.heading = heading;
  for (Eigen::Isometry3d& X_WF : target.X_WF) {
    X_WF = Eigen::Translation3d(plan_origin()) *
           Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
           Eigen::Translation3d(0.4, 0.0, 0.0);
  }
  return target;
}

const core::JumpPlan& lifted() {
  static const core::JumpPlan plan = [] {
    core::JumpPlan out;
    const SolvedJump& jump = level_jump();
    EXPECT_TRUE(lift_to_3d(jump.model, jump.motion, target(kHeading), out));
    return out;
  }();
  return plan;
}

TEST(LiftTo3d, CentreOfMassAndItsVelocityAreThoseOfTheWholeRobot) {
  for (std::size_t i = 0; i < lifted().knot_count; ++i) {
    const core::JumpKnot& knot = lifted().knots[i];
    const model::CompositeBody body =
        model::composite_body(level_jump().model.robot, model::state_of(knot));
    EXPECT_LT((body.p_WG - knot.p_WG).norm(), kExact) << i;
    EXPECT_LT((body.v_WG - knot.v_WG).norm(), kExact) << i;
  }
}

TEST(LiftTo3d, StandingFeetStandStillWhereTheyShould) {
  const core::JumpPlan& plan = lifted();
  const Eigen::Vector3d along(std::cos(kHeading), std::sin(kHeading), 0.0);
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    const core::JumpKnot& knot = plan.knots[i];
    if (knot.phase == core::JumpPhase::flight) continue;
    const std::array<Eigen::Isometry3d, core::kLegs> soles =
        model::sole_poses(level_jump().model.robot, model::state_of(knot));
    const Eigen::Vector3d middle = 0.5 * (soles[0].translation() + soles[1].translation());
    const double distance = knot.phase == core::JumpPhase::landing ? 0.4 : 0.0;
    EXPECT_LT((middle - plan_origin() - distance * along).norm(), kSolved) << i;
    EXPECT_NEAR(model::rpy_from_rotation(soles[0].linear()).z(), kHeading, kExact) << i;
    EXPECT_NEAR(model::rpy_from_rotation(soles[0].linear()).y(), 0.0, kSolved) << i;
  }
}

TEST(LiftTo3d, WrenchesCarryTheWeightAtRestInTheFinalPosture) {
  const core::JumpKnot& last = lifted().knots[lifted().knot_count - 1];
  const double weight = level_jump().model.dynamics.chain().total_mass() * model::kGravity;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const core::Wrench& wrench : last.wrenches) force += wrench.force;
  EXPECT_NEAR(force.z(), weight, kSolved * weight);
  EXPECT_LT(force.head<2>().norm(), kSolved * weight);
  EXPECT_EQ(last.dt, 0.0);
  EXPECT_LT(last.dq.norm(), kSolved);
}

/// Newton and Euler of the whole robot in W: force and moment about G of both wrenches.
TEST(LiftTo3d, WrenchesTurnTheRobotAsItsMomentumChanges) {
  const core::JumpPlan& plan = lifted();
  const model::RobotParameters& robot = level_jump().model.robot;
  for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(level_jump().model.config.steps.takeoff);
       ++i) {
    const core::RobotState here = model::state_of(plan.knots[i]);
    const core::RobotState next = model::state_of(plan.knots[i + 1]);
    const model::CompositeBody a = model::composite_body(robot, here);
    const model::CompositeBody b = model::composite_body(robot, next);
    const std::array<Eigen::Isometry3d, core::kLegs> soles = model::sole_poses(robot, here);
    const Eigen::Vector3d centre = 0.5 * (a.p_WG + b.p_WG);
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      const core::Wrench& wrench = plan.knots[i].wrenches[leg];
      moment += wrench.moment + (soles[leg].translation() - centre).cross(wrench.force);
    }
    const Eigen::Vector3d rate = (b.momentum_W - a.momentum_W) / plan.knots[i].dt;
    constexpr double kMidpointRule = 1.0;  // [N·m] of up to 40
    EXPECT_LT((moment - rate).norm(), kMidpointRule) << i;
  }
}

TEST(LiftTo3d, FeetInFlightGetNoForce) {
  for (std::size_t i = 0; i < lifted().knot_count; ++i) {
    const core::JumpKnot& knot = lifted().knots[i];
    const bool flight = knot.phase == core::JumpPhase::flight;
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      EXPECT_EQ(knot.contact[leg], !flight);
      if (flight) {
        EXPECT_EQ(knot.wrenches[leg].force.norm(), 0.0);
      }
    }
  }
}

TEST(LiftTo3d, HeadingOnlyTurnsThePlan) {
  core::JumpPlan straight;
  ASSERT_TRUE(lift_to_3d(level_jump().model, level_jump().motion, target(0.0), straight));
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(kHeading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (std::size_t i = 0; i < straight.knot_count; ++i) {
    const core::JumpKnot& a = straight.knots[i];
    const core::JumpKnot& b = lifted().knots[i];
    EXPECT_LT((turn * (a.p_WB - plan_origin()) - (b.p_WB - plan_origin())).norm(), kExact);
    EXPECT_LT((turn * a.v_WG - b.v_WG).norm(), kExact);
    EXPECT_LT((turn * a.w_WB - b.w_WB).norm(), kExact);
    EXPECT_LT((turn * a.wrenches[0].force - b.wrenches[0].force).norm(), 1e-6);
    EXPECT_LT((turn * a.wrenches[0].moment - b.wrenches[0].moment).norm(), 1e-6);
    EXPECT_EQ(a.q, b.q);
    EXPECT_EQ(a.tau, b.tau);
  }
}

}  // namespace
}  // namespace hopscotch::planner
