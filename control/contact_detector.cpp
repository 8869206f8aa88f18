#include "control/contact_detector.hpp"

#include <Eigen/Cholesky>

#include "model/joint_momentum.hpp"
#include "model/kinematics.hpp"

namespace hopscotch::control {

namespace {

/// Levers shorter than this say nothing about a force: a straight leg must not divide by zero [m].
constexpr double kLeverMin = 0.015;

/// The vertical force in W that explains joint torques as those of the ground on a line foot, which
/// bears all but a moment about its length: least squares.
double vertical_force(const model::RobotParameters& robot, core::Leg leg,
                      const core::RobotState& state, const core::LegVector& torque) {
  const core::LegVector q = state.q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
  const Eigen::Matrix<double, 6, core::kJointsPerLeg> J = model::sole_jacobian(robot, leg, q);
  Eigen::Matrix<double, core::kJointsPerLeg, 5> levers;
  levers.leftCols<3>() = J.topRows<3>().transpose() * state.R_WB.transpose();
  levers.rightCols<2>() = J.bottomRows<2>().transpose();
  Eigen::Matrix<double, 5, 5> normal = levers.transpose() * levers;
  normal.diagonal().array() += kLeverMin * kLeverMin;
  const Eigen::Vector<double, 5> wrench = normal.ldlt().solve(levers.transpose() * torque);
  return wrench(2);
}

}  // namespace

ContactDetector::ContactDetector(const ContactConfig& config, const model::RobotParameters& robot)
    : config_(config), robot_(robot) {}

void ContactDetector::observe(core::Leg leg, const core::RobotState& state,
                              const core::SensorReadings& readings, double dt) noexcept {
  Foot& foot = feet_[core::index(leg)];
  const int first = core::leg_offset(leg);
  const model::LegMomentum now = model::leg_momentum(robot_, leg, state);
  if (foot.known) {
    const core::LegVector known =
        0.5 * (foot.drift + now.drift) + readings.tau.segment<core::kJointsPerLeg>(first) -
        model::joint_friction(robot_, state.dq.segment<core::kJointsPerLeg>(first));
    const core::LegVector jump = (now.momentum - foot.momentum) / dt - known;
    const double share = std::min(config_.residual_rate * dt, 1.0);
    foot.residual += share * (jump - foot.residual);
    foot.spike = vertical_force(robot_, leg, state, jump);
    foot.force = vertical_force(robot_, leg, state, foot.residual);
  }
  foot.momentum = now.momentum;
  foot.drift = now.drift;
  foot.known = true;
}

double ContactDetector::threshold(ContactExpectation expected) const noexcept {
  switch (expected) {
    case ContactExpectation::support: return config_.support_force;
    case ContactExpectation::leaving:
    case ContactExpectation::airborne: return config_.airborne_force;
    case ContactExpectation::touchdown: return config_.touchdown_force;
  }
  return config_.support_force;
}

const std::array<bool, core::kLegs>& ContactDetector::update(const core::RobotState& state,
                                                             const core::SensorReadings& readings,
                                                             ContactExpectation expected,
                                                             double dt) noexcept {
  for (const core::Leg leg : core::kAllLegs) {
    observe(leg, state, readings, dt);
    Foot& foot = feet_[core::index(leg)];
    bool& contact = contact_[core::index(leg)];
    const bool spiked =
        expected == ContactExpectation::touchdown && foot.spike > config_.spike_force;
    if (foot.force > threshold(expected) || spiked) {
      contact = true;
      foot.unloaded = 0.0;
    } else if (foot.force < config_.lost_force) {
      foot.unloaded += dt;
      if (foot.unloaded >= config_.lost_time) contact = false;
    }
  }
  return contact_;
}

}  // namespace hopscotch::control
