#include "control/wrench_mpc_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/unit/control/dense_qp.hpp"
#include "tests/unit/control/mpc_samples.hpp"

namespace hopscotch::control {
namespace {

constexpr double kGravity = 9.80665;

TEST(RpyRate, IsTheDerivativeOfRollPitchYaw) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr double kStep = 1e-6;       // [s]
  constexpr double kTolerance = 1e-8;  // central difference: kStep^2 and rounding over kStep
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d rpy(uniform(rng), uniform(rng), uniform(rng));
    const Eigen::Vector3d w(uniform(rng), uniform(rng), uniform(rng));
    const Eigen::Matrix3d R = model::rotation_from_rpy(rpy);
    const auto turned = [&](double time) {
      const Eigen::Vector3d turn = time * w;
      const Eigen::Matrix3d step =
          Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
      return Eigen::Vector3d(model::rpy_from_rotation(step * R));
    };
    // AngleAxis takes its angle as positive, so the way back needs the opposite axis: -time does.
    const Eigen::Vector3d numeric = (turned(kStep) - turned(-kStep)) / (2.0 * kStep);
    EXPECT_LE((rpy_rate(rpy) * w - numeric).norm(), kTolerance);
  }
}

class WrenchMpcProblem : public ::testing::Test {
 protected:
  WrenchQp posed(const core::RobotState& state, const core::ControlReference& reference,
                 MpcForm form) {
    WrenchQp qp = constant_part(config_, robot_);
    pose_problem(robot_, state, reference, form, qp);
    return qp;
  }
  /// Standing, disturbed in everything.
  core::RobotState disturbed(double yaw) const {
    core::RobotState state = testing::standing(robot_, yaw);
    state.R_WB = state.R_WB * model::rotation_from_rpy({0.05, 0.2, 0.03});
    state.v_WB = {0.3, -0.1, -0.4};
    state.w_WB = {0.2, 0.5, -0.1};
    return state;
  }

  WrenchMpcConfig config_ = WrenchMpcConfig::load(testing::mpc_section());
  model::RobotParameters robot_ = testing::hector();
};

TEST_F(WrenchMpcProblem, ConeHoldsTheCentreOfPressureOnTheSole) {
  const WrenchQp qp = constant_part(config_, robot_);
  // F is 10 mm ahead of the ankle; a centre of pressure at x needs My = -x Fz.
  EXPECT_NEAR(qp.cone.lower(kMomentY), config_.cop_toe - 0.010, 1e-12);
  EXPECT_NEAR(qp.cone.upper(kMomentY), config_.cop_heel + 0.010, 1e-12);
  EXPECT_LT(config_.cop_toe, robot_.toe);
  EXPECT_LT(config_.cop_heel, robot_.heel);
}

TEST_F(WrenchMpcProblem, PredictionIsTheMotionOfTheRigidBody) {
  // Against a fine integration of Newton and Euler with attitude as a rotation matrix. The error
  // of the linear model is of second order in the step, so it falls to a quarter at half a step.
  const core::RobotState state = disturbed(0.7);
  const model::CompositeBody body = model::composite_body(robot_, state);
  const auto X_WF = model::sole_poses(robot_, state);
  const Eigen::Vector3d force(20.0, -10.0, 90.0);
  const Eigen::Vector3d moment_F(0.0, 2.0, 1.0);
  const auto error_of = [&](double dt) {
    const core::ControlReference reference = testing::stay(robot_, state, 1, dt);
    const WrenchQp qp = posed(state, reference, MpcForm::full);
    const Heading heading = heading_of(reference);
    const testing::DenseQp dense = testing::condense(qp);
    testing::DenseVector z(10);
    const double yaw = reference.knots[0].rpy.z();
    z << 20.0L, -10.0L, 2.0L, 1.0L, 90.0L, 20.0L, -10.0L, 2.0L, 1.0L, 90.0L;
    const BodyState predicted = (dense.free + dense.gain * z).cast<double>();

    const Eigen::Matrix3d R_WH = heading.R_HW.transpose();
    const Eigen::Matrix3d inertia_B = state.R_WB.transpose() * body.inertia_W * state.R_WB;
    Eigen::Vector3d p = body.p_WG;
    Eigen::Vector3d v = body.v_WG;
    Eigen::Vector3d w = state.w_WB;
    Eigen::Matrix3d R = state.R_WB;
    constexpr int kFine = 2000;
    const double h = dt / kFine;
    for (int i = 0; i < kFine; ++i) {
      Eigen::Vector3d torque = Eigen::Vector3d::Zero();
      for (const Eigen::Isometry3d& X : X_WF) {
        torque += (X.translation() - p).cross(R_WH * force) + R_WH * moment_F;
      }
      const Eigen::Matrix3d inertia = R * inertia_B * R.transpose();
      p += h * v;
      v += h * (2.0 / body.mass * (R_WH * force) - kGravity * Eigen::Vector3d::UnitZ());
      const Eigen::Vector3d turn = h * w;
      w += h * inertia.inverse() * (torque - w.cross(inertia * w));
      R = (Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * R).eval();
    }
    BodyState truth;
    Eigen::Vector3d rpy = model::rpy_from_rotation(R);
    rpy.z() -= yaw;
    truth << heading.R_HW * (p - heading.p_WH), rpy, heading.R_HW * v, heading.R_HW * w;
    return (truth - predicted).eval();
  };
  const BodyState coarse = error_of(0.01);
  const BodyState fine = error_of(0.005);
  // The gyroscopic torque is left out of the model: an error of first order in the rate.
  const double gyroscopic = 0.01 * 3.0 * state.w_WB.squaredNorm();
  EXPECT_LE(coarse.head<3>().norm(), 1e-5);
  EXPECT_LE(coarse.segment<3>(3).norm(), 1e-3);
  EXPECT_LE(coarse.segment<3>(6).norm(), 1e-9);
  EXPECT_LE(coarse.tail<3>().norm(), gyroscopic + 0.03);
  EXPECT_LE(fine.segment<3>(3).norm(), 0.3 * coarse.segment<3>(3).norm());
}

TEST_F(WrenchMpcProblem, YawOfTheWorldDoesNotChangeTheProblem) {
  const core::RobotState state = disturbed(0.0);
  const core::ControlReference reference = testing::stay(robot_, testing::standing(robot_), 3);
  const core::RobotState turned_state = disturbed(3.0);
  core::RobotState turned = turned_state;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  turned.v_WB = turn * state.v_WB;
  turned.w_WB = turn * state.w_WB;
  const core::ControlReference turned_reference =
      testing::stay(robot_, testing::standing(robot_, 3.0), 3);
  const WrenchQp a = posed(state, reference, MpcForm::full);
  const WrenchQp b = posed(turned, turned_reference, MpcForm::full);
  constexpr double kRounding = 1e-13;
  EXPECT_LE((a.x0 - b.x0).norm(), kRounding);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LE((a.stages[k].target - b.stages[k].target).norm(), kRounding);
    EXPECT_LE((a.stages[k].inertia_inverse - b.stages[k].inertia_inverse).norm(), kRounding);
    EXPECT_LE((a.stages[k].feet[0].p_GF - b.stages[k].feet[0].p_GF).norm(), kRounding);
    EXPECT_LE((a.stages[k].feet[0].R_force - b.stages[k].feet[0].R_force).norm(), kRounding);
  }
}

TEST_F(WrenchMpcProblem, YawGoesOnPastHalfATurn) {
  const core::RobotState state = testing::standing(robot_, 3.1);
  core::ControlReference reference = testing::stay(robot_, state, 3);
  const double yaws[] = {3.1, -3.15, -3.1, -3.05};  // given with and without jumps by a turn
  for (std::size_t k = 0; k <= 3; ++k) reference.knots[k].rpy.z() = yaws[k];
  const WrenchQp qp = posed(state, reference, MpcForm::full);
  const double full_turn = 2.0 * std::acos(-1.0);
  EXPECT_NEAR(qp.x0(5), 0.0, 1e-12);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(qp.stages[k].target(5), yaws[k + 1] + full_turn - 3.1, 1e-12);
  }
}

TEST_F(WrenchMpcProblem, ErrorStateStartsAtTheTrackingError) {
  const core::RobotState state = disturbed(0.4);
  const core::ControlReference reference = testing::stay(robot_, testing::standing(robot_, 0.4), 2);
  const WrenchQp full = posed(state, reference, MpcForm::full);
  const WrenchQp error = posed(state, reference, MpcForm::error_state);
  EXPECT_LE((error.x0 - (full.x0 - full.stages[0].target)).norm(), 1e-13);  // same target: a stay
  EXPECT_EQ(error.stages[0].target, BodyState::Zero());
}

TEST_F(WrenchMpcProblem, PlannedWrenchesKeepTheErrorAtZero) {
  core::RobotState state = testing::standing(robot_, 0.4);
  core::ControlReference reference = testing::stay(robot_, state, 3);
  for (core::ReferenceKnot& knot : reference.knots) {
    knot.wrenches[0] = {{10.0, 3.0, 90.0}, {0.0, 0.0, 0.3}};
    knot.wrenches[1] = {{5.0, -3.0, 60.0}, {0.0, 0.0, -0.2}};
  }
  const testing::DenseQp dense = testing::condense(posed(state, reference, MpcForm::error_state));
  // The cost about the reference has its minimum where state error and wrench error vanish.
  const testing::DenseVector z = dense.H.llt().solve(-dense.g);
  EXPECT_LE(static_cast<double>(dense.objective(z)), 1e-12);
  EXPECT_NEAR(static_cast<double>(z(4)), 90.0, 1e-6);
}

TEST_F(WrenchMpcProblem, FirstStepTakesTheFeetWhereTheyAre) {
  const core::RobotState state = disturbed(0.0);
  core::ControlReference reference = testing::stay(robot_, testing::standing(robot_), 2);
  for (core::ReferenceKnot& knot : reference.knots) knot.p_WF[0].x() += 0.05;
  const WrenchQp qp = posed(state, reference, MpcForm::full);
  const Eigen::Vector3d p_GF =
      model::sole_poses(robot_, state)[0].translation() - model::composite_body(robot_, state).p_WG;
  EXPECT_LE((qp.stages[0].feet[0].p_GF - p_GF).norm(), 1e-13);
  EXPECT_LE(
      (qp.stages[1].feet[0].p_GF - (reference.knots[1].p_WF[0] - reference.knots[1].p_WG)).norm(),
      1e-13);
}

TEST_F(WrenchMpcProblem, RefusesNumbersThatAreNone) {
  const core::RobotState state = testing::standing(robot_);
  const core::ControlReference reference = testing::stay(robot_, state, 4);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(can_pose(state, reference, 4));
  const auto accepts_state = [&](const auto& spoil) {
    core::RobotState spoiled = state;
    spoil(spoiled);
    return can_pose(spoiled, reference, 4);
  };
  EXPECT_FALSE(accepts_state([](core::RobotState& s) { s.p_WB.x() = kNaN; }));
  EXPECT_FALSE(accepts_state([](core::RobotState& s) { s.R_WB(1, 1) = kNaN; }));
  EXPECT_FALSE(accepts_state([](core::RobotState& s) { s.v_WB.z() = kNaN; }));
  EXPECT_FALSE(accepts_state([](core::RobotState& s) { s.w_WB.y() = kNaN; }));
  EXPECT_FALSE(accepts_state([](core::RobotState& s) { s.q(7) = kNaN; }));
  EXPECT_FALSE(accepts_state([](core::RobotState& s) { s.dq(2) = kNaN; }));
  EXPECT_FALSE(accepts_state([](core::RobotState& s) {
    s.R_WB = model::rotation_from_rpy({0.0, 1.5, 0.0});
  }));
  const auto accepts = [&](const auto& spoil) {
    core::ControlReference spoiled = reference;
    spoil(spoiled);
    return can_pose(state, spoiled, 4);
  };
  using Reference = core::ControlReference;
  EXPECT_FALSE(accepts([](Reference& r) { r.horizon = 0; }));
  EXPECT_FALSE(accepts([](Reference& r) { r.horizon = 5; }));
  EXPECT_FALSE(accepts([](Reference& r) { r.knots[3].dt = 0.0; }));
  EXPECT_TRUE(accepts([](Reference& r) { r.knots[4].dt = 0.0; }));  // only ends the window
  EXPECT_FALSE(accepts([](Reference& r) { r.knots[4].v_WG.x() = kNaN; }));
  EXPECT_FALSE(accepts([](Reference& r) { r.knots[1].p_WF[1].x() = kNaN; }));
  EXPECT_FALSE(accepts([](Reference& r) { r.knots[1].wrenches[1].force.z() = kNaN; }));
  EXPECT_TRUE(accepts([](Reference& r) {
    r.knots[1].contact[1] = false;
    r.knots[1].p_WF[1].x() = kNaN;
  }));
}

}  // namespace
}  // namespace hopscotch::control
