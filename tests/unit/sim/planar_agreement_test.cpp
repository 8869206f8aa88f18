// The sagittal chain against MuJoCo: a robot with equal legs, zero yaw and roll moves in the plane,
// so its projected 3-D dynamics must be those of model::PlanarDynamics.
#include <gtest/gtest.h>

#include <random>

#include "model/planar_dynamics.hpp"
#include "model/rigid_body.hpp"
#include "tests/unit/sim/mujoco_robot.hpp"

namespace hopscotch::sim {
namespace {

using Eigen::Vector3d;
using model::LinkArray;
using model::PlanarDynamics;
using model::PlanarJoints;
using model::PlanarVector;
using Velocity = MujocoRobot::Velocity;

constexpr double kAgreement = 1e-8;
constexpr int kTrials = 25;

/// Pitches, rates and accelerations of the four links.
struct PlanarMotion {
  LinkArray<double> a{};
  LinkArray<double> w{};
  LinkArray<double> acceleration{};
};

PlanarMotion random_motion(std::mt19937& rng) {
  const auto draw = [&rng](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng);
  };
  PlanarMotion motion;
  motion.a = {0.0, draw(0.2, 1.2), draw(-1.2, -0.2), draw(-0.6, 0.8)};
  for (std::size_t i = model::kShank; i < model::kPlanarLinks; ++i) {
    motion.w[i] = draw(-8.0, 8.0);
    motion.acceleration[i] = draw(-200.0, 200.0);
  }
  return motion;
}

Vector3d in_space(double x, double z) {
  return {x, 0.0, z};
}

core::JointVector both_legs(const PlanarJoints<double>& one) {
  core::LegVector leg;
  leg << 0.0, 0.0, one.hip, one.knee, one.ankle;
  core::JointVector both;
  both << leg, leg;
  return both;
}

/// Vectors from ankle to knee, knee to hip and hip to B, at the present pitches.
LinkArray<PlanarVector<double>> segments(const PlanarDynamics& planar, const LinkArray<double>& a) {
  const model::PlanarChain& chain = planar.chain();
  return {PlanarVector<double>{0.0, 0.0},
          PlanarDynamics::turned(0.0, chain.shank.length, a[model::kShank]),
          PlanarDynamics::turned(0.0, chain.thigh.length, a[model::kThigh]),
          PlanarDynamics::turned(chain.trunk_x, chain.trunk_z, a[model::kTrunk])};
}

/// Generalised velocity in 3-D of link rates about the fixed ankle axis.
Velocity velocity_3d(const PlanarDynamics& planar, const LinkArray<double>& a,
                     const LinkArray<double>& w) {
  const LinkArray<PlanarVector<double>> r = segments(planar, a);
  Vector3d v = Vector3d::Zero();
  for (std::size_t i = 0; i < r.size(); ++i) v += w[i] * in_space(r[i].z, -r[i].x);
  Velocity velocity;
  velocity << v, 0.0, w[model::kTrunk], 0.0, both_legs(model::joints_from_links(w));
  return velocity;
}

/// Its derivative: the same map of the accelerations, and the centripetal part.
Velocity acceleration_3d(const PlanarDynamics& planar, const PlanarMotion& motion) {
  const LinkArray<PlanarVector<double>> r = segments(planar, motion.a);
  Velocity acceleration = velocity_3d(planar, motion.a, motion.acceleration);
  for (std::size_t i = 0; i < r.size(); ++i) {
    acceleration.head<3>() -= motion.w[i] * motion.w[i] * in_space(r[i].x, r[i].z);
  }
  return acceleration;
}

/// The robot with its ankle axis on the y axis of W.
core::RobotState state_3d(const PlanarDynamics& planar, const PlanarMotion& motion) {
  const PlanarVector<double> p_AB = planar.trunk_origin(motion.a);
  const Velocity velocity = velocity_3d(planar, motion.a, motion.w);
  core::RobotState state;
  state.p_WB = in_space(p_AB.x, p_AB.z);
  state.R_WB = model::rotation_from_rpy(Vector3d(0.0, motion.a[model::kTrunk], 0.0));
  state.v_WB = velocity.head<3>();
  state.w_WB = motion.w[model::kTrunk] * Vector3d::UnitY();
  state.q = both_legs(model::joints_from_links(motion.a));
  state.dq = velocity.tail<core::kJoints>();
  return state;
}

class PlanarAgreement : public testing::TestWithParam<const char*> {
 protected:
  MujocoRobot mujoco{GetParam()};
  PlanarDynamics planar{model::lump_legs(mujoco.robot)};
  std::mt19937 rng{51};

  /// Virtual rates of one link, feet fixed.
  Velocity virtual_velocity(const PlanarMotion& motion, std::size_t link) const {
    LinkArray<double> unit{};
    unit[link] = 1.0;
    return velocity_3d(planar, motion.a, unit);
  }
};

INSTANTIATE_TEST_SUITE_P(Robots, PlanarAgreement, testing::Values("hector", "hector-d14"),
                         [](const auto& robot) {
                           return std::string(robot.param) == "hector" ? "R" : "D14";
                         });

TEST_P(PlanarAgreement, MassMatrixOfPinnedFeetIsMuJoCosProjected) {
  for (int trial = 0; trial < kTrials; ++trial) {
    PlanarMotion motion = random_motion(rng);
    motion.w = {};
    mujoco.place(state_3d(planar, motion));
    motion.acceleration = {};
    const PlanarJoints<double> still =
        planar.stance_loads(motion.a, motion.w, motion.acceleration).tau;
    for (std::size_t k = model::kShank; k < model::kPlanarLinks; ++k) {
      motion.acceleration = {};
      motion.acceleration[k] = 1.0;
      const PlanarJoints<double> loads =
          planar.stance_loads(motion.a, motion.w, motion.acceleration).tau;
      const PlanarJoints<double> inertial{loads.hip - still.hip, loads.knee - still.knee,
                                          loads.ankle - still.ankle};
      const Velocity column = mujoco.mass_matrix() * virtual_velocity(motion, k);
      for (std::size_t j = model::kShank; j < model::kPlanarLinks; ++j) {
        LinkArray<double> unit{};
        unit[j] = 1.0;
        const PlanarJoints<double> rate = model::joints_from_links(unit);
        const double planar_entry =
            rate.hip * inertial.hip + rate.knee * inertial.knee + rate.ankle * inertial.ankle;
        EXPECT_NEAR(planar_entry, virtual_velocity(motion, j).dot(column), kAgreement);
      }
    }
  }
}

TEST_P(PlanarAgreement, StanceTorquesAreMuJoCosInverseDynamics) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const PlanarMotion motion = random_motion(rng);
    mujoco.place(state_3d(planar, motion));
    const Velocity force =
        mujoco.mass_matrix() * acceleration_3d(planar, motion) + mujoco.bias() - mujoco.passive();
    const PlanarJoints<double> tau =
        planar.stance_loads(motion.a, motion.w, motion.acceleration).tau;
    // Ground forces do no work on fixed feet: only joint torques remain in the projection.
    for (std::size_t j = model::kShank; j < model::kPlanarLinks; ++j) {
      LinkArray<double> unit{};
      unit[j] = 1.0;
      const PlanarJoints<double> rate = model::joints_from_links(unit);
      EXPECT_NEAR(rate.hip * tau.hip + rate.knee * tau.knee + rate.ankle * tau.ankle,
                  virtual_velocity(motion, j).dot(force), kAgreement);
    }
  }
}

TEST_P(PlanarAgreement, BiasOfPinnedFeetIsMuJoCosProjected) {
  for (int trial = 0; trial < kTrials; ++trial) {
    PlanarMotion motion = random_motion(rng);
    motion.acceleration = {};  // Coriolis, centrifugal, gravity and damping alone
    mujoco.place(state_3d(planar, motion));
    const Velocity force =
        mujoco.mass_matrix() * acceleration_3d(planar, motion) + mujoco.bias() - mujoco.passive();
    const PlanarJoints<double> tau = planar.stance_loads(motion.a, motion.w, {}).tau;
    EXPECT_NEAR(-tau.hip, virtual_velocity(motion, model::kTrunk).dot(force), kAgreement);
    EXPECT_NEAR(tau.hip - tau.knee, virtual_velocity(motion, model::kThigh).dot(force), kAgreement);
    EXPECT_NEAR(tau.knee - tau.ankle, virtual_velocity(motion, model::kShank).dot(force),
                kAgreement);
  }
}

TEST_P(PlanarAgreement, GroundReactionIsMuJoCosRateOfMomentum) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const PlanarMotion motion = random_motion(rng);
    const core::RobotState state = state_3d(planar, motion);
    mujoco.place(state);
    const model::StanceLoads<double> loads =
        planar.stance_loads(motion.a, motion.w, motion.acceleration);
    const Velocity wrench = mujoco.mass_matrix() * acceleration_3d(planar, motion) + mujoco.bias();
    EXPECT_NEAR(loads.force.x, wrench(0), kAgreement);
    EXPECT_NEAR(loads.force.z, wrench(2), kAgreement);
    EXPECT_NEAR(wrench(1), 0.0, kAgreement);
    const Vector3d about_ankle =
        state.R_WB * wrench.segment<3>(3) + state.p_WB.cross(Vector3d(wrench.head<3>()));
    EXPECT_NEAR(loads.moment, about_ankle.y(), kAgreement);
  }
}

TEST_P(PlanarAgreement, CentroidalMotionIsThatOfTheBodyInSpace) {
  for (int trial = 0; trial < kTrials; ++trial) {
    PlanarMotion motion = random_motion(rng);
    motion.a[model::kFoot] = 0.4;
    motion.w[model::kFoot] = -5.0;
    const model::CompositeBody body = model::composite_body(mujoco.robot, state_3d(planar, motion));
    const PlanarVector<double> com = planar.com(motion.a);
    const PlanarVector<double> velocity = planar.com_velocity(motion.a, motion.w);
    EXPECT_LE((body.p_WG - in_space(com.x, com.z)).norm(), kAgreement);
    EXPECT_LE((body.v_WG - in_space(velocity.x, velocity.z)).norm(), kAgreement);
    EXPECT_NEAR(body.momentum_W.y(), planar.centroidal_momentum(motion.a, motion.w), kAgreement);
  }
}

/// Motions of the robot in its plane: forward, up, pitch; hip, knee and ankle of both legs.
Eigen::Matrix<double, MujocoRobot::kVelocities, 6> plane_motions() {
  Eigen::Matrix<double, MujocoRobot::kVelocities, 6> basis;
  basis.setZero();
  basis(0, 0) = basis(2, 1) = basis(4, 2) = 1.0;
  basis.col(3).tail<core::kJoints>() = both_legs({.hip = 1.0, .knee = 0.0, .ankle = 0.0});
  basis.col(4).tail<core::kJoints>() = both_legs({.hip = 0.0, .knee = 1.0, .ankle = 0.0});
  basis.col(5).tail<core::kJoints>() = both_legs({.hip = 0.0, .knee = 0.0, .ankle = 1.0});
  return basis;
}

TEST_P(PlanarAgreement, FlightTorquesAreThoseThatMoveMuJoCo) {
  const Eigen::Matrix<double, MujocoRobot::kVelocities, 6> basis = plane_motions();
  for (int trial = 0; trial < kTrials; ++trial) {
    PlanarMotion motion = random_motion(rng);
    motion.a[model::kFoot] = 0.3;
    motion.w[model::kFoot] = 4.0;
    const Vector3d tau = model::random_vector<3>(20.0, rng);  // hip, knee, ankle of one leg
    mujoco.place(state_3d(planar, motion));
    Velocity force = mujoco.passive() - mujoco.bias();
    force.tail<core::kJoints>() += both_legs({.hip = tau(0), .knee = tau(1), .ankle = tau(2)});
    const Eigen::Vector<double, 6> result =
        (basis.transpose() * mujoco.mass_matrix() * basis).ldlt().solve(basis.transpose() * force);
    const double trunk = result(2);
    const double thigh = trunk + result(3);
    const double shank = thigh + result(4);
    const double foot = shank + result(5);
    const PlanarJoints<double> loads =
        planar.flight_torques(motion.a, motion.w, {foot, shank, thigh, trunk});
    EXPECT_NEAR(loads.hip, 2.0 * tau(0), kAgreement);
    EXPECT_NEAR(loads.knee, 2.0 * tau(1), kAgreement);
    EXPECT_NEAR(loads.ankle, 2.0 * tau(2), kAgreement);
  }
}

}  // namespace
}  // namespace hopscotch::sim
