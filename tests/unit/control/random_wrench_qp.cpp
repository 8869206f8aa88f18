#include "tests/unit/control/random_wrench_qp.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace hopscotch::control::testing {

namespace {

double uniform(double magnitude, std::mt19937& rng) {
  return std::uniform_real_distribution<double>(-magnitude, magnitude)(rng);
}

template <int N>
Eigen::Vector<double, N> vector(double magnitude, std::mt19937& rng) {
  Eigen::Vector<double, N> out;
  for (int i = 0; i < N; ++i) out(i) = uniform(magnitude, rng);
  return out;
}

Eigen::Matrix3d rotation(double magnitude, std::mt19937& rng) {
  const Eigen::Vector3d turn = vector<3>(magnitude, rng);
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
}

bool in_contact(ContactPattern pattern, int k, int leg) {
  switch (pattern) {
    case ContactPattern::both: return true;
    case ContactPattern::left_only: return leg == 0;
    case ContactPattern::alternating: return (k / 2 + leg) % 2 == 0;
    case ContactPattern::through_flight: return k < 3 || k > 6;
  }
  return true;
}

WrenchQpStage random_stage(const QpFamily& family, int k, std::mt19937& rng) {
  constexpr double kGravity = 9.81;
  WrenchQpStage stage;
  stage.dt = family.dt * (1.0 + uniform(0.5, rng));
  stage.rpy_rate.block<2, 2>(0, 0) =
      Eigen::Rotation2Dd(uniform(family.spread, rng)).toRotationMatrix();
  stage.rpy_rate(2, 0) = uniform(family.spread, rng);
  const Eigen::Matrix3d R = rotation(family.spread, rng);
  stage.inertia_inverse = R * Eigen::Vector3d(2.3, 2.7, 6.8).asDiagonal() * R.transpose();
  stage.velocity_gain.head<3>() = Eigen::Vector3d(0.0, 0.0, -kGravity * stage.dt);
  stage.target = vector<12>(0.3 * family.spread, rng);
  for (int leg = 0; leg < core::kLegs; ++leg) {
    WrenchQpFoot& foot = stage.feet[static_cast<std::size_t>(leg)];
    foot.contact = in_contact(family.contact, k, leg);
    foot.p_GF = Eigen::Vector3d(0.0, leg == 0 ? 0.1 : -0.1, -0.4) + vector<3>(0.03, rng);
    foot.R_force = rotation(0.5 * family.spread, rng);
    foot.R_moment = rotation(0.5 * family.spread, rng);
    if (family.with_reference) foot.reference << 5.0, -3.0, 1.0, 0.2, 80.0;
  }
  return stage;
}

}  // namespace

WrenchQp random_wrench_qp(const QpFamily& family, std::mt19937& rng) {
  WrenchQp qp;
  qp.horizon = family.horizon;
  qp.mass = 14.0;
  qp.rule = family.rule;
  qp.x0 = vector<12>(family.spread, rng);
  qp.state_weight << 300, 300, 400, 150, 200, 150, 20, 20, 1, 1, 5, 10;
  qp.input_weight.setConstant(1e-6 * family.weight_scale);
  const double yaw_arm = family.yaw_moment_free ? WrenchCone::kFree : 0.03;
  qp.cone.upper << family.friction, family.friction, 0.065, yaw_arm;
  qp.cone.lower << family.friction, family.friction, 0.085, yaw_arm;
  qp.cone.max_normal_force = family.top;
  for (int k = 0; k < qp.horizon; ++k) {
    qp.stages[static_cast<std::size_t>(k)] = random_stage(family, k, rng);
  }
  return qp;
}

}  // namespace hopscotch::control::testing
