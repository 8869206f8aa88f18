#include "sim/ankle_coupling.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/sim/mujoco_robot.hpp"

namespace hopscotch::sim {
namespace {

using core::Joint;
using core::Leg;

constexpr double kAgreement = 1e-8;

/// Reflected inertia of all rotors: each motor's own, at the rate that it turns with.
MujocoRobot::MassMatrix rotor_matrix(const model::RobotParameters& robot) {
  MujocoRobot::MassMatrix rotors = MujocoRobot::MassMatrix::Zero();
  for (const Leg leg : core::kAllLegs) {
    for (std::size_t i = 0; i < robot.motors.size(); ++i) {
      MujocoRobot::Velocity rate = MujocoRobot::Velocity::Zero();  // d(motor rate) / d(qvel)
      rate(6 + core::joint_index(leg, static_cast<Joint>(i))) = 1.0;
      if (static_cast<Joint>(i) == Joint::ankle) {
        rate(6 + core::joint_index(leg, Joint::knee)) = 1.0;
      }
      rotors += robot.motors[i].armature * rate * rate.transpose();
    }
  }
  return rotors;
}

TEST(AnkleCoupling, RotorsCountAtTheRatesTheyTurnWith) {
  MujocoRobot mujoco("hector");
  std::mt19937 rng(41);
  mujoco.place(model::random_state(mujoco.robot, rng));
  const MujocoRobot::MassMatrix with_rotors = mujoco.mass_matrix();
  for (int i = 0; i < mujoco.mj->nv; ++i) mujoco.mj->dof_armature[i] = 0.0;
  mj_forward(mujoco.mj.get(), mujoco.data.get());
  const MujocoRobot::MassMatrix links_only = mujoco.mass_matrix();
  EXPECT_LE((with_rotors - links_only - rotor_matrix(mujoco.robot)).norm(), kAgreement);
}

TEST(AnkleCoupling, AccelerationsObeyTheCoupledMassMatrix) {
  MujocoRobot mujoco("hector");
  std::mt19937 rng(42);
  for (int trial = 0; trial < 10; ++trial) {
    const core::RobotState state = model::random_state(mujoco.robot, rng);
    const core::JointVector tau = model::random_vector<core::kJoints>(20.0, rng);
    Eigen::Map<core::JointVector>(mujoco.data->ctrl) = tau;
    mujoco.place(state);
    MujocoRobot::Velocity force = mujoco.passive() - mujoco.bias();
    force.tail<core::kJoints>() += tau;
    EXPECT_LE((mujoco.mass_matrix() * mujoco.acceleration() - force).norm(), kAgreement);
  }
}

TEST(AnkleCoupling, StepIsImplicitInDampingWithTheCoupledMassMatrix) {
  MujocoRobot mujoco("hector");
  std::mt19937 rng(43);
  const core::RobotState state = model::random_state(mujoco.robot, rng);
  mujoco.place(state);
  const double dt = mujoco.mj->opt.timestep;
  MujocoRobot::MassMatrix implicit = mujoco.mass_matrix();
  implicit.diagonal() += dt * Eigen::Map<const MujocoRobot::Velocity>(mujoco.mj->dof_damping);
  const MujocoRobot::Velocity before = Eigen::Map<MujocoRobot::Velocity>(mujoco.data->qvel);
  const MujocoRobot::Velocity expected =
      before + dt * implicit.ldlt().solve(mujoco.passive() - mujoco.bias());
  mujoco.coupling.step(*mujoco.mj, *mujoco.data);
  const MujocoRobot::Velocity after = Eigen::Map<MujocoRobot::Velocity>(mujoco.data->qvel);
  EXPECT_LE((after - expected).norm(), kAgreement);
}

TEST(AnkleCoupling, FlightWithoutLossesKeepsEnergyAndMomentum) {
  // Energy of first-order steps drifts with the step length: 0.2 s at 0.05 ms stay within 1e-3.
  constexpr double kRelativeDrift = 1e-3;
  MujocoRobot mujoco("hector");
  std::mt19937 rng(44);
  core::RobotState state = model::random_state(mujoco.robot, rng);
  for (int i = 0; i < mujoco.mj->nv; ++i) mujoco.mj->dof_damping[i] = 0.0;
  mujoco.mj->opt.timestep = 5e-5;
  mju_zero3(mujoco.mj->opt.gravity);
  mujoco.place(state);
  const auto energy = [&mujoco] {
    const MujocoRobot::Velocity v = Eigen::Map<MujocoRobot::Velocity>(mujoco.data->qvel);
    return 0.5 * v.dot(mujoco.mass_matrix() * v);
  };
  const double start = energy();
  for (int i = 0; i < 4000; ++i) mujoco.coupling.step(*mujoco.mj, *mujoco.data);
  mujoco.coupling.forward(*mujoco.mj, *mujoco.data);
  EXPECT_NEAR(energy() / start, 1.0, kRelativeDrift);
}

}  // namespace
}  // namespace hopscotch::sim
