#include "control/wrench_mpc.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/allocation_count.hpp"
#include "tests/unit/control/mpc_samples.hpp"

namespace hopscotch::control {
namespace {

constexpr double kGravity = 9.80665;
constexpr std::size_t kHorizon = 10;

class WrenchMpcTest : public ::testing::Test {
 protected:
  core::ContactWrenches solved(const core::RobotState& state,
                               const core::ControlReference& reference, MpcForm form) {
    WrenchMpc mpc(config_, robot_);
    core::ContactWrenches wrenches;
    EXPECT_EQ(mpc.solve(state, reference, form, wrenches), MpcStatus::solved);
    return wrenches;
  }

  /// Falls forward, turns and leans to one side.
  core::RobotState disturbed(double yaw) const {
    core::RobotState state = testing::standing(robot_, yaw);
    const Eigen::Matrix3d R_WH = state.R_WB;
    state.R_WB = R_WH * model::rotation_from_rpy({0.04, 0.1, 0.03});
    state.v_WB = R_WH * Eigen::Vector3d(0.2, -0.1, -0.3);
    state.w_WB = R_WH * Eigen::Vector3d(0.2, 0.5, -0.1);
    return state;
  }

  WrenchMpcConfig config_ = WrenchMpcConfig::load(testing::mpc_section());
  model::RobotParameters robot_ = testing::hector();
};

/// Two solutions of one problem in other coordinates agree as far as the stopping rule says: a gap
/// of 1e-8 moves a force with weight 1e-6 by at most 0.1 N, a moment likewise by 0.1 N·m.
constexpr double kForceTolerance = 0.1;

TEST_F(WrenchMpcTest, StandingFeetShareTheWeightEqually) {
  const core::RobotState state = testing::standing(robot_);
  const core::ContactWrenches wrenches =
      solved(state, testing::stay(robot_, state, kHorizon), MpcForm::full);
  const double weight = robot_.total_mass() * kGravity;
  // The cost on wrenches and the open end of the window make it a little less than the weight.
  EXPECT_NEAR(wrenches[0].force.z() + wrenches[1].force.z(), weight, 0.01 * weight);
  EXPECT_NEAR(wrenches[0].force.z(), wrenches[1].force.z(), kForceTolerance);
}

TEST_F(WrenchMpcTest, StandingCentreOfPressureIsBelowTheCentreOfMass) {
  const core::RobotState state = testing::standing(robot_);
  const core::ContactWrenches wrenches =
      solved(state, testing::stay(robot_, state, kHorizon), MpcForm::full);
  const double com_x = model::composite_body(robot_, state).p_WG.x();
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    const double sole_x = model::sole_poses(robot_, state)[leg].translation().x();
    const double cop_x = sole_x - wrenches[leg].moment.y() / wrenches[leg].force.z();
    EXPECT_NEAR(cop_x, com_x, 2e-3);  // 0.1 N·m of the tolerance on 69 N
  }
}

TEST_F(WrenchMpcTest, OnThePlanTheErrorStateGivesThePlannedWrenches) {
  const core::RobotState state = testing::standing(robot_);
  core::ControlReference reference = testing::stay(robot_, state, kHorizon, 0.01);
  for (core::ReferenceKnot& knot : reference.knots) {
    knot.wrenches[0] = {{20.0, 4.0, 150.0}, {0.0, 2.0, 1.0}};
    knot.wrenches[1] = {{25.0, -4.0, 170.0}, {0.0, 1.0, -1.0}};
  }
  const core::ContactWrenches wrenches = solved(state, reference, MpcForm::error_state);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    const core::Wrench& planned = reference.knots[0].wrenches[leg];
    EXPECT_LE((wrenches[leg].force - planned.force).norm(), 2.0 * kForceTolerance);
    EXPECT_LE((wrenches[leg].moment - planned.moment).norm(), 2.0 * kForceTolerance);
  }
}

TEST_F(WrenchMpcTest, ErrorStatePushesAgainstTheError) {
  core::RobotState state = testing::standing(robot_);
  core::ControlReference reference = testing::stay(robot_, state, kHorizon, 0.01);
  state.v_WB.z() = -0.2;  // slower upwards than planned
  const core::ContactWrenches wrenches = solved(state, reference, MpcForm::error_state);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    EXPECT_GT(wrenches[leg].force.z(), reference.knots[0].wrenches[leg].force.z() + 5.0);
  }
}

TEST_F(WrenchMpcTest, FallingForwardMovesTheCentreOfPressureToTheToes) {
  core::RobotState state = testing::standing(robot_);
  const core::ControlReference reference = testing::stay(robot_, state, kHorizon);
  const core::ContactWrenches calm = solved(state, reference, MpcForm::full);
  state.v_WB.x() = 0.3;
  const core::ContactWrenches wrenches = solved(state, reference, MpcForm::full);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    const double cop = -wrenches[leg].moment.y() / wrenches[leg].force.z();
    EXPECT_GT(cop, -calm[leg].moment.y() / calm[leg].force.z() + 0.01);
    EXPECT_LT(wrenches[leg].force.x(), 0.0);
  }
}

TEST_F(WrenchMpcTest, WrenchesLieInTheCone) {
  core::RobotState state = disturbed(0.0);
  state.v_WB = {1.5, 0.8, -2.0};  // more than the feet can stop
  const core::ContactWrenches wrenches =
      solved(state, testing::stay(robot_, testing::standing(robot_), kHorizon), MpcForm::full);
  constexpr double kRounding = 1e-9;  // [N]
  for (const core::Wrench& wrench : wrenches) {
    const double normal = wrench.force.z();
    EXPECT_GE(normal, 0.0);
    EXPECT_LE(normal, config_.max_normal_force + kRounding);
    EXPECT_LE(std::abs(wrench.force.x()), config_.friction * normal + kRounding);
    EXPECT_LE(std::abs(wrench.force.y()), config_.friction * normal + kRounding);
    EXPECT_LE(std::abs(wrench.moment.z()), config_.yaw_moment_arm * normal + kRounding);
    EXPECT_EQ(wrench.moment.x(), 0.0);
    const double cop_from_ankle = robot_.sole_centre() - wrench.moment.y() / normal;
    EXPECT_LE(cop_from_ankle, config_.cop_toe + kRounding);
    EXPECT_GE(cop_from_ankle, -config_.cop_heel - kRounding);
  }
}

TEST_F(WrenchMpcTest, FootInFlightGetsNoForce) {
  const core::RobotState state = testing::standing(robot_);
  core::ControlReference reference = testing::stay(robot_, state, kHorizon);
  for (core::ReferenceKnot& knot : reference.knots) knot.contact[1] = false;
  const core::ContactWrenches wrenches = solved(state, reference, MpcForm::full);
  EXPECT_GT(wrenches[0].force.z(), 50.0);
  EXPECT_EQ(wrenches[1].force, Eigen::Vector3d::Zero());
  EXPECT_EQ(wrenches[1].moment, Eigen::Vector3d::Zero());
}

TEST_F(WrenchMpcTest, WindowInFlightGivesNoForceAtAll) {
  const core::RobotState state = testing::standing(robot_);
  core::ControlReference reference = testing::stay(robot_, state, kHorizon);
  for (core::ReferenceKnot& knot : reference.knots) knot.contact = {false, false};
  const core::ContactWrenches wrenches = solved(state, reference, MpcForm::full);
  for (const core::Wrench& wrench : wrenches) EXPECT_EQ(wrench.force, Eigen::Vector3d::Zero());
}

TEST_F(WrenchMpcTest, MirroredProblemGivesMirroredWrenches) {
  const Eigen::Vector3d mirror(1.0, -1.0, 1.0);        // of vectors in the plane y = 0
  const Eigen::Vector3d mirror_turn(-1.0, 1.0, -1.0);  // of axial vectors
  const core::RobotState state = disturbed(0.0);
  core::RobotState mirrored = state;
  const Eigen::Vector3d rpy = model::rpy_from_rotation(state.R_WB);
  mirrored.R_WB = model::rotation_from_rpy(mirror_turn.cwiseProduct(rpy));
  mirrored.p_WB = mirror.cwiseProduct(state.p_WB);
  mirrored.v_WB = mirror.cwiseProduct(state.v_WB);
  mirrored.w_WB = mirror_turn.cwiseProduct(state.w_WB);
  const core::ControlReference reference =
      testing::stay(robot_, testing::standing(robot_), kHorizon);
  const core::ContactWrenches a = solved(state, reference, MpcForm::full);
  const core::ContactWrenches b = solved(mirrored, reference, MpcForm::full);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    EXPECT_LE((mirror.cwiseProduct(a[leg].force) - b[1 - leg].force).norm(), kForceTolerance);
    EXPECT_LE((mirror_turn.cwiseProduct(a[leg].moment) - b[1 - leg].moment).norm(),
              kForceTolerance);
  }
}

TEST_F(WrenchMpcTest, TurnedProblemGivesTurnedWrenches) {
  for (const MpcForm form : {MpcForm::full, MpcForm::error_state}) {
    const core::ContactWrenches straight =
        solved(disturbed(0.0), testing::stay(robot_, testing::standing(robot_), kHorizon), form);
    for (const double yaw : {0.6, -1.7, 3.14159}) {
      const core::ContactWrenches turned = solved(
          disturbed(yaw), testing::stay(robot_, testing::standing(robot_, yaw), kHorizon), form);
      const Eigen::Matrix3d R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
        EXPECT_LE((R * straight[leg].force - turned[leg].force).norm(), kForceTolerance);
        EXPECT_LE((R * straight[leg].moment - turned[leg].moment).norm(), kForceTolerance);
      }
    }
  }
}

TEST_F(WrenchMpcTest, BadInputLeavesTheWrenchesAlone) {
  WrenchMpc mpc(config_, robot_);
  core::RobotState state = testing::standing(robot_);
  const core::ControlReference reference = testing::stay(robot_, state, kHorizon);
  state.v_WB.x() = std::numeric_limits<double>::quiet_NaN();
  core::ContactWrenches wrenches;
  wrenches[0].force = {1.0, 2.0, 3.0};
  wrenches[1].moment = {4.0, 5.0, 6.0};
  EXPECT_EQ(mpc.solve(state, reference, MpcForm::full, wrenches), MpcStatus::bad_input);
  EXPECT_EQ(wrenches[0].force, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(wrenches[1].moment, Eigen::Vector3d(4.0, 5.0, 6.0));
}

TEST_F(WrenchMpcTest, IterationLimitLeavesTheWrenchesAlone) {
  config_.tolerances.iteration_cap = 1;
  WrenchMpc mpc(config_, robot_);
  const core::RobotState state = testing::standing(robot_);
  core::ContactWrenches wrenches;
  wrenches[0].force = {1.0, 2.0, 3.0};
  EXPECT_EQ(mpc.solve(state, testing::stay(robot_, state, kHorizon), MpcForm::full, wrenches),
            MpcStatus::iteration_limit);
  EXPECT_EQ(wrenches[0].force, Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST_F(WrenchMpcTest, SecondSolveStartsFromTheFirst) {
  WrenchMpc mpc(config_, robot_);
  core::RobotState state = testing::standing(robot_);
  core::ControlReference reference = testing::stay(robot_, state, kHorizon);
  core::ContactWrenches wrenches;
  ASSERT_EQ(mpc.solve(state, reference, MpcForm::full, wrenches), MpcStatus::solved);
  EXPECT_FALSE(mpc.statistics().warm);
  const int cold = mpc.statistics().iterations;
  reference.stamp = state.stamp = state.stamp.after(0.005);
  ASSERT_EQ(mpc.solve(state, reference, MpcForm::full, wrenches), MpcStatus::solved);
  EXPECT_TRUE(mpc.statistics().warm);
  EXPECT_LE(mpc.statistics().iterations, cold);
  ASSERT_EQ(mpc.solve(state, reference, MpcForm::error_state, wrenches), MpcStatus::solved);
  EXPECT_FALSE(mpc.statistics().warm);  // another cost: its multipliers are no guess
}

TEST_F(WrenchMpcTest, WarmAndColdGiveTheSameWrenches) {
  const core::ControlReference reference =
      testing::stay(robot_, testing::standing(robot_), kHorizon);
  WrenchMpc mpc(config_, robot_);
  core::ContactWrenches warm;
  ASSERT_EQ(mpc.solve(testing::standing(robot_), reference, MpcForm::full, warm),
            MpcStatus::solved);
  ASSERT_EQ(mpc.solve(disturbed(0.0), reference, MpcForm::full, warm), MpcStatus::solved);
  const core::ContactWrenches cold = solved(disturbed(0.0), reference, MpcForm::full);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    EXPECT_LE((warm[leg].force - cold[leg].force).norm(), kForceTolerance);
  }
}

TEST_F(WrenchMpcTest, SameHistoryGivesTheSameBits) {
  const core::ControlReference reference =
      testing::stay(robot_, testing::standing(robot_), kHorizon);
  const auto run = [&] {
    WrenchMpc mpc(config_, robot_);
    core::ContactWrenches wrenches;
    EXPECT_EQ(mpc.solve(testing::standing(robot_), reference, MpcForm::full, wrenches),
              MpcStatus::solved);
    EXPECT_EQ(mpc.solve(disturbed(0.1), reference, MpcForm::full, wrenches), MpcStatus::solved);
    return wrenches;
  };
  const core::ContactWrenches first = run();
  const core::ContactWrenches second = run();
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    EXPECT_EQ(first[leg].force, second[leg].force);
    EXPECT_EQ(first[leg].moment, second[leg].moment);
  }
}

TEST_F(WrenchMpcTest, SolvingAllocatesNothing) {
  WrenchMpc mpc(config_, robot_);
  const core::RobotState state = disturbed(0.3);
  const core::ControlReference reference =
      testing::stay(robot_, testing::standing(robot_, 0.3), kHorizon);
  core::ContactWrenches wrenches;
  const std::size_t before = core::allocation_count();
  const MpcStatus cold = mpc.solve(state, reference, MpcForm::full, wrenches);
  const MpcStatus warm = mpc.solve(state, reference, MpcForm::full, wrenches);
  const MpcStatus other = mpc.solve(state, reference, MpcForm::error_state, wrenches);
  const std::size_t after = core::allocation_count();
  EXPECT_EQ(cold, MpcStatus::solved);
  EXPECT_EQ(warm, MpcStatus::solved);
  EXPECT_EQ(other, MpcStatus::solved);
  EXPECT_EQ(after, before);
}

TEST_F(WrenchMpcTest, ShorterWindowIsAllowed) {
  const core::RobotState state = testing::standing(robot_);
  const core::ContactWrenches wrenches =
      solved(state, testing::stay(robot_, state, 3), MpcForm::full);
  EXPECT_GT(wrenches[0].force.z(), 0.0);
}

}  // namespace
}  // namespace hopscotch::control
