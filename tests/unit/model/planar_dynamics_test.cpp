#include "model/planar_dynamics.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>

namespace hopscotch::model {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
/// Reference values are printed to five decimals, holding torques to four.
constexpr double kPrinted = 1.1e-5;
constexpr double kPrintedTorque = 1.1e-4;
/// Central differences with a step of 1e-6 of quantities up to 1e3.
constexpr double kDifference = 1e-6;
constexpr double kDifferenceError = 2e-5;
constexpr int kSamples = 50;

PlanarChain chain_of(const std::string& robot) {
  return lump_legs(RobotParameters::load(std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config" /
                                         "robots" / (robot + ".yaml")));
}

/// Links without rotors and friction, as the reference values have it.
PlanarDynamics bare(const std::string& robot) {
  PlanarChain chain = chain_of(robot);
  chain.armature_hip = chain.armature_knee = chain.armature_ankle = 0.0;
  chain.damping_hip = chain.damping_knee = chain.damping_ankle = 0.0;
  return PlanarDynamics(chain);
}

/// Pitches of a flat-footed robot with these joint angles [deg].
LinkArray<double> links(double ankle, double knee, double hip) {
  const double shank = -ankle * kDegree;
  const double thigh = shank - knee * kDegree;
  return {0.0, shank, thigh, thigh - hip * kDegree};
}

/// Joint torques as (ankle, knee, hip).
Eigen::Vector3d torques(const PlanarDynamics& dynamics, const LinkArray<double>& a,
                        const LinkArray<double>& w, const LinkArray<double>& u) {
  const PlanarJoints<double> tau = dynamics.stance_loads(a, w, u).tau;
  return {tau.ankle, tau.knee, tau.hip};
}

/// Mass matrix in (ankle, knee, hip), from the torques of unit joint accelerations.
Eigen::Matrix3d mass_matrix(const PlanarDynamics& dynamics, const LinkArray<double>& a) {
  const Eigen::Vector3d bias = torques(dynamics, a, {}, {});
  Eigen::Matrix3d mass;
  mass.col(0) = torques(dynamics, a, {}, {0.0, -1.0, -1.0, -1.0}) - bias;
  mass.col(1) = torques(dynamics, a, {}, {0.0, 0.0, -1.0, -1.0}) - bias;
  mass.col(2) = torques(dynamics, a, {}, {0.0, 0.0, 0.0, -1.0}) - bias;
  return mass;
}

struct ReferencePose {
  const char* robot;
  double ankle, knee, hip;              // [deg]
  double aa, ak, ah, kk, kh, hh;        // mass matrix [kg·m^2]
  double tau_ankle, tau_knee, tau_hip;  // holding torques [N·m]
};

class ReferencePoses : public testing::TestWithParam<ReferencePose> {};

TEST_P(ReferencePoses, HaveTheKnownMassMatrixAndHoldingTorques) {
  const ReferencePose& pose = GetParam();
  const PlanarDynamics dynamics = bare(pose.robot);
  const LinkArray<double> a = links(pose.ankle, pose.knee, pose.hip);
  Eigen::Matrix3d expected;
  expected << pose.aa, pose.ak, pose.ah, pose.ak, pose.kk, pose.kh, pose.ah, pose.kh, pose.hh;
  EXPECT_LT((mass_matrix(dynamics, a) - expected).cwiseAbs().maxCoeff(), kPrinted);
  const Eigen::Vector3d tau = torques(dynamics, a, {}, {});
  EXPECT_NEAR(tau(0), pose.tau_ankle, kPrintedTorque);
  EXPECT_NEAR(tau(1), pose.tau_knee, kPrintedTorque);
  EXPECT_NEAR(tau(2), pose.tau_hip, kPrintedTorque);
}

INSTANTIATE_TEST_SUITE_P(
    Hector, ReferencePoses,
    testing::Values(ReferencePose{"hector", 0, 0, 0, 3.68354, 2.20367, .80218, 1.36418, .54240,
                                  .28261, 2.1767, 2.1767, 2.1786},
                    ReferencePose{"hector", 45, -90, 45, 2.21988, 1.43030, .65000, 1.28112, .50087,
                                  .28261, .1536, 20.4492, 2.1786},
                    ReferencePose{"hector", 60, -120, 60, 1.42496, .98681, .54240, 1.18905, .45483,
                                  .28261, -.3008, 24.5561, 2.1786},
                    ReferencePose{"hector-d14", 0, 0, 0, 4.08577, 2.50261, .98624, 1.58030, .67392,
                                  .36161, 2.8625, 2.8063, 2.7834},
                    ReferencePose{"hector-d14", 45, -90, 45, 2.49885, 1.66183, .80329, 1.48566,
                                  .62660, .36161, 1.1649, 22.0266, 2.7834},
                    ReferencePose{"hector-d14", 60, -120, 60, 1.63026, 1.17278, .67392, 1.37614,
                                  .57184, .36161, .7722, 26.3431, 2.7834}));

/// Random motions, the same in every run.
class PlanarMotions : public testing::Test {
 protected:
  LinkArray<double> random(double size) {
    std::uniform_real_distribution<double> spread(-size, size);
    LinkArray<double> out;
    for (double& each : out) each = spread(generator_);
    return out;
  }
  LinkArray<double> flat(LinkArray<double> link) {
    link[kFoot] = 0.0;
    return link;
  }
  /// State `dt` later with constant accelerations.
  static LinkArray<double> moved(const LinkArray<double>& a, const LinkArray<double>& w,
                                 const LinkArray<double>& u, double dt) {
    LinkArray<double> out;
    for (std::size_t j = 0; j < kPlanarLinks; ++j) out[j] = a[j] + dt * (w[j] + 0.5 * dt * u[j]);
    return out;
  }
  static LinkArray<double> sped(const LinkArray<double>& w, const LinkArray<double>& u, double dt) {
    LinkArray<double> out;
    for (std::size_t j = 0; j < kPlanarLinks; ++j) out[j] = w[j] + dt * u[j];
    return out;
  }
  /// d/dt of f(a, w) along the motion.
  template <typename F>
  static double rate(F f, const LinkArray<double>& a, const LinkArray<double>& w,
                     const LinkArray<double>& u) {
    return (f(moved(a, w, u, kDifference), sped(w, u, kDifference)) -
            f(moved(a, w, u, -kDifference), sped(w, u, -kDifference))) /
           (2.0 * kDifference);
  }

  PlanarDynamics dynamics_{chain_of("hector")};
  PlanarDynamics bare_ = bare("hector");
  std::mt19937 generator_{7};
};

TEST_F(PlanarMotions, CentreOfMassVelocityIsTheRateOfItsPosition) {
  for (int i = 0; i < kSamples; ++i) {
    const LinkArray<double> a = random(1.2);
    const LinkArray<double> w = random(5.0);
    const PlanarVector<double> v = dynamics_.com_velocity(a, w);
    const auto x = [&](const auto& p, const auto&) { return dynamics_.com(p).x; };
    const auto z = [&](const auto& p, const auto&) { return dynamics_.com(p).z; };
    EXPECT_NEAR(v.x, rate(x, a, w, {}), kDifferenceError);
    EXPECT_NEAR(v.z, rate(z, a, w, {}), kDifferenceError);
  }
}

TEST_F(PlanarMotions, TrunkVelocityIsTheRateOfItsPosition) {
  const LinkArray<double> a = random(1.2);
  const LinkArray<double> w = random(5.0);
  const PlanarVector<double> v = dynamics_.trunk_origin_velocity(a, w);
  const auto x = [&](const auto& p, const auto&) { return dynamics_.trunk_origin(p).x; };
  const auto z = [&](const auto& p, const auto&) { return dynamics_.trunk_origin(p).z; };
  EXPECT_NEAR(v.x, rate(x, a, w, {}), kDifferenceError);
  EXPECT_NEAR(v.z, rate(z, a, w, {}), kDifferenceError);
}

TEST_F(PlanarMotions, GroundForceIsTheRateOfMomentumPlusWeight) {
  const double mass = dynamics_.chain().total_mass();
  for (int i = 0; i < kSamples; ++i) {
    const LinkArray<double> a = flat(random(1.2));
    const LinkArray<double> w = flat(random(8.0));
    const LinkArray<double> u = flat(random(100.0));
    const StanceLoads<double> loads = dynamics_.stance_loads(a, w, u);
    const auto px = [&](const auto& p, const auto& v) {
      return mass * dynamics_.com_velocity(p, v).x;
    };
    const auto pz = [&](const auto& p, const auto& v) {
      return mass * dynamics_.com_velocity(p, v).z;
    };
    EXPECT_NEAR(loads.force.x, rate(px, a, w, u), kDifferenceError * mass);
    EXPECT_NEAR(loads.force.z - mass * kGravity, rate(pz, a, w, u), kDifferenceError * mass);
  }
}

TEST_F(PlanarMotions, GroundMomentIsTheRateOfAngularMomentumAboutTheAnkle) {
  const double mass = dynamics_.chain().total_mass();
  for (int i = 0; i < kSamples; ++i) {
    const LinkArray<double> a = flat(random(1.2));
    const LinkArray<double> w = flat(random(8.0));
    const LinkArray<double> u = flat(random(100.0));
    // About +y: r x v = z v_x - x v_z.
    const auto about_ankle = [&](const auto& p, const auto& v) {
      const PlanarVector<double> r = dynamics_.com(p);
      const PlanarVector<double> c = dynamics_.com_velocity(p, v);
      return dynamics_.centroidal_momentum(p, v) + mass * (r.z * c.x - r.x * c.z);
    };
    const double gravity = mass * kGravity * dynamics_.com(a).x;
    EXPECT_NEAR(dynamics_.stance_loads(a, w, u).moment + gravity, rate(about_ankle, a, w, u),
                kDifferenceError * mass);
  }
}

TEST_F(PlanarMotions, JointPowerIsTheRateOfEnergy) {
  const double mass = bare_.chain().total_mass();
  for (int i = 0; i < kSamples; ++i) {
    const LinkArray<double> a = flat(random(1.2));
    const LinkArray<double> w = flat(random(8.0));
    const LinkArray<double> u = flat(random(100.0));
    const auto energy = [&](const auto& p, const auto& v) {
      const PlanarJoints<double> q = joints_from_links(v);
      const Eigen::Vector3d dq(q.ankle, q.knee, q.hip);
      return 0.5 * dq.dot(mass_matrix(bare_, p) * dq) + mass * kGravity * bare_.com(p).z;
    };
    const PlanarJoints<double> tau = bare_.stance_loads(a, w, u).tau;
    const PlanarJoints<double> dq = joints_from_links(w);
    const double power = tau.hip * dq.hip + tau.knee * dq.knee + tau.ankle * dq.ankle;
    EXPECT_NEAR(power, rate(energy, a, w, u), kDifferenceError * (1.0 + std::abs(power)));
  }
}

TEST_F(PlanarMotions, RotorsAndDampingLoadTheMotorsThatTheyTurnWith) {
  const PlanarChain& chain = dynamics_.chain();
  const LinkArray<double> a = flat(random(1.0));
  const LinkArray<double> w = flat(random(5.0));
  const LinkArray<double> u = flat(random(50.0));
  const PlanarJoints<double> with = motor_torques_from_joints(dynamics_.stance_loads(a, w, u).tau);
  const PlanarJoints<double> without = motor_torques_from_joints(bare_.stance_loads(a, w, u).tau);
  const PlanarJoints<double> acceleration = motor_rates_from_links(u);
  const PlanarJoints<double> dq = joints_from_links(w);
  constexpr double kRounding = 1e-10;
  EXPECT_NEAR(with.hip - without.hip,
              chain.armature_hip * acceleration.hip + chain.damping_hip * dq.hip, kRounding);
  EXPECT_NEAR(with.knee - without.knee,
              chain.armature_knee * acceleration.knee + chain.damping_knee * dq.knee -
                  chain.damping_ankle * dq.ankle,
              kRounding);
  EXPECT_NEAR(with.ankle - without.ankle,
              chain.armature_ankle * acceleration.ankle + chain.damping_ankle * dq.ankle,
              kRounding);
}

TEST_F(PlanarMotions, MotorAndJointPowerAreTheSame) {
  const LinkArray<double> w = random(5.0);
  const PlanarJoints<double> tau{3.0, -20.0, 7.0};
  const PlanarJoints<double> dq = joints_from_links(w);
  const PlanarJoints<double> motor = motor_torques_from_joints(tau);
  const PlanarJoints<double> speed = motor_rates_from_links(w);
  EXPECT_NEAR(tau.hip * dq.hip + tau.knee * dq.knee + tau.ankle * dq.ankle,
              motor.hip * speed.hip + motor.knee * speed.knee + motor.ankle * speed.ankle, 1e-12);
}

TEST_F(PlanarMotions, MomentumRateIsTheRateOfMomentum) {
  for (int i = 0; i < kSamples; ++i) {
    const LinkArray<double> a = random(1.2);
    const LinkArray<double> w = random(8.0);
    const LinkArray<double> u = random(100.0);
    const auto momentum = [&](const auto& p, const auto& v) {
      return dynamics_.centroidal_momentum(p, v);
    };
    EXPECT_NEAR(dynamics_.momentum_rate(a, w, u), rate(momentum, a, w, u), kDifferenceError);
  }
}

/// Kinetic energy of the links about their common CoM, link by link.
double energy_about_com(const PlanarDynamics& dynamics, const LinkArray<double>& a,
                        const LinkArray<double>& w) {
  const PlanarChain& chain = dynamics.chain();
  const std::array<PlanarLink, kPlanarLinks> link{chain.foot, chain.shank, chain.thigh,
                                                  chain.trunk};
  const PlanarVector<double> centre = dynamics.com_velocity(a, w);
  PlanarVector<double> joint{0.0, 0.0};  // velocity of the link's lower joint
  double energy = 0.0;
  for (std::size_t j = 0; j < kPlanarLinks; ++j) {
    const PlanarVector<double> com = PlanarDynamics::turned(link[j].com_x, link[j].com_z, a[j]);
    const double vx = joint.x + w[j] * com.z - centre.x;
    const double vz = joint.z - w[j] * com.x - centre.z;
    energy += 0.5 * link[j].mass * (vx * vx + vz * vz) + 0.5 * link[j].inertia * w[j] * w[j];
    const PlanarVector<double> along = PlanarDynamics::turned(0.0, link[j].length, a[j]);
    joint.x += w[j] * along.z;
    joint.z -= w[j] * along.x;
  }
  return energy;
}

TEST_F(PlanarMotions, FlightTorquesDoTheWorkThatTheLinksGain) {
  for (int i = 0; i < kSamples; ++i) {
    const LinkArray<double> a = random(1.2);
    const LinkArray<double> w = random(8.0);
    LinkArray<double> u = random(100.0);
    // The rate of momentum is linear in the foot's acceleration: choose that for none.
    u[kFoot] = 0.0;
    const double without = bare_.momentum_rate(a, w, u);
    u[kFoot] = 1.0;
    u[kFoot] = without / (without - bare_.momentum_rate(a, w, u));
    ASSERT_NEAR(bare_.momentum_rate(a, w, u), 0.0, 1e-9);
    const auto energy = [&](const auto& p, const auto& v) { return energy_about_com(bare_, p, v); };
    const PlanarJoints<double> tau = bare_.flight_torques(a, w, u);
    const PlanarJoints<double> dq = joints_from_links(w);
    const double power = tau.hip * dq.hip + tau.knee * dq.knee + tau.ankle * dq.ankle;
    EXPECT_NEAR(power, rate(energy, a, w, u), kDifferenceError * (1.0 + std::abs(power)));
  }
}

TEST_F(PlanarMotions, StandingPressesWithTheWeightBelowTheCentreOfMass) {
  const LinkArray<double> a = links(45, -90, 45);
  const StanceLoads<double> loads = dynamics_.stance_loads(a, {}, {});
  const double weight = dynamics_.chain().total_mass() * kGravity;
  EXPECT_NEAR(loads.force.z, weight, 1e-9);
  EXPECT_NEAR(loads.force.x, 0.0, 1e-9);
  EXPECT_NEAR(-loads.moment / weight, dynamics_.com(a).x, 1e-12);
}

}  // namespace
}  // namespace hopscotch::model
