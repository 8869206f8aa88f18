#include "control/state_estimator.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "model/kinematics.hpp"

namespace hopscotch::control {

namespace {

/// Longer gaps between readings are integrated as if they were this long [s].
constexpr double kStepMax = 0.02;

bool is_finite(const core::SensorReadings& readings) {
  return readings.q.allFinite() && readings.dq.allFinite() && readings.tau.allFinite() &&
         readings.w_WB_B.allFinite() && readings.f_B.allFinite();
}

core::LegVector of_leg(const core::JointVector& all, core::Leg leg) {
  return all.segment<core::kJointsPerLeg>(core::leg_offset(leg));
}

}  // namespace

StateEstimator::StateEstimator(const EstimatorConfig& config, const model::RobotParameters& robot,
                               const StartPlace& start)
    : config_(config),
      robot_(robot),
      start_(start),
      detector_(config.contact, robot),
      flight_check_(config.flight_check) {}

/// Both soles level on the whole, their mid-point at the start place.
FilterState StateEstimator::first_guess(const core::SensorReadings& readings) const noexcept {
  Eigen::Vector3d up_B = Eigen::Vector3d::Zero();
  Eigen::Vector3d middle_B = Eigen::Vector3d::Zero();
  for (const core::Leg leg : core::kAllLegs) {
    const Eigen::Isometry3d X_BF = model::leg_poses(robot_, leg, of_leg(readings.q, leg)).X_BF;
    up_B += 0.5 * X_BF.linear().col(2);
    middle_B += 0.5 * X_BF.translation();
  }
  const double pitch = std::atan2(-up_B.x(), std::hypot(up_B.y(), up_B.z()));
  const double roll = std::atan2(up_B.y(), up_B.z());
  FilterState guess;
  guess.R_WB = model::rotation_from_rpy({roll, pitch, start_.yaw});
  guess.p_WB = start_.p_WS - guess.R_WB * middle_B;
  return guess;
}

SeenFoot StateEstimator::see(core::Leg leg, const core::JointVector& q) const noexcept {
  const core::LegVector leg_q = of_leg(q, leg);
  const Eigen::Matrix<double, 3, core::kJointsPerLeg> J =
      model::sole_jacobian(robot_, leg, leg_q).topRows<3>();
  const double variance = config_.filter.encoder_sigma * config_.filter.encoder_sigma;
  return {model::leg_poses(robot_, leg, leg_q).X_BF.translation(), variance * J * J.transpose()};
}

/// A sole that rolls over toe or heel, or has only just come down, is no good landmark.
double StateEstimator::creep(core::Leg leg, const core::SensorReadings& readings) const noexcept {
  const FilterConfig& c = config_.filter;
  const Eigen::Matrix<double, 3, core::kJointsPerLeg> J =
      model::sole_jacobian(robot_, leg, of_leg(readings.q, leg)).bottomRows<3>();
  const Eigen::Vector3d turning =
      readings.w_WB_B - filter_->state().gyro_bias + J * of_leg(readings.dq, leg);
  return c.foot_density + c.roll_density * turning.norm() +
         c.impact_density * std::exp(-standing_for_[core::index(leg)] / c.impact_time);
}

void StateEstimator::publish(const core::SensorReadings& readings) noexcept {
  const FilterState& now = filter_->state();
  state_.stamp = readings.stamp;
  state_.p_WB = now.p_WB;
  state_.R_WB = now.R_WB;
  state_.v_WB = now.v_WB;
  state_.w_WB = now.R_WB * (readings.w_WB_B - now.gyro_bias);
  state_.q = readings.q;
  state_.dq = readings.dq;
}

void StateEstimator::use_feet(const core::SensorReadings& readings, ContactExpectation expected,
                              double dt) noexcept {
  const std::array<bool, core::kLegs> contact = detector_.update(state_, readings, expected, dt);
  state_.contact = contact;
  for (const core::Leg leg : core::kAllLegs) {
    const std::size_t i = core::index(leg);
    // Shortly before lift-off soles slip and roll; the inertial sensor alone is better for so long.
    const bool usable = contact[i] && expected != ContactExpectation::leaving;
    if (!usable) {
      filter_->remove_foot(leg);
      continue;
    }
    const SeenFoot seen = see(leg, readings.q);
    if (!filter_->stands(leg)) {
      filter_->add_foot(leg, seen);
      standing_for_[i] = 0.0;
      continue;
    }
    standing_for_[i] += dt;
    if (filter_->correct_foot(leg, seen) == FootVerdict::slipped) ++counts_.slips;
  }
}

/// A flight in which the inertial sensor was wrong left a speed that the soles contradict.
void StateEstimator::check_flight(const core::SensorReadings& readings, double dt) noexcept {
  SolesNow now{.rise_speed = filter_->state().v_WB.z()};
  const Eigen::Isometry3d level(filter_->state().R_WB);
  for (const core::Leg leg : core::kAllLegs) {
    now.standing += filter_->stands(leg) ? 1 : 0;
    // A sole that rolls over toe or heel moves, and the tip that it rolls over does not.
    const Eigen::Isometry3d X_BF = model::leg_poses(robot_, leg, of_leg(readings.q, leg)).X_BF;
    const model::SoleTips tips = model::sole_tips(robot_, level * X_BF);
    now.below[core::index(leg)] = std::min(tips.toe.z(), tips.heel.z());
  }
  const std::optional<FlightError> error = flight_check_.update(now, dt);
  // What the filter admits by itself, after a hard impact for one, the soles correct by themselves.
  constexpr double kSigmas = 4.0;
  constexpr int kRise = InvariantFilter::kVelocity + 2;
  const double admitted = kSigmas * std::sqrt(filter_->covariance()(kRise, kRise));
  if (!error || std::abs(error->rise_speed) <= admitted) return;
  ++counts_.flights_doubted;
  filter_->doubt_flight(*error);
}

const core::RobotState& StateEstimator::update(const core::SensorReadings& readings,
                                               ContactExpectation expected) noexcept {
  if (!is_finite(readings)) {
    ++counts_.bad_readings;
    state_.stamp = readings.stamp;
    state_.q = readings.q;
    state_.dq = readings.dq;
    if (!readings.w_WB_B.allFinite() || !readings.f_B.allFinite())
      state_.w_WB.setConstant(core::kNaN);
    return state_;
  }
  if (filter_ && readings.stamp <= state_.stamp) return state_;
  const double dt = filter_ ? std::min(readings.stamp.since(state_.stamp), kStepMax) : 0.0;
  if (!filter_) {
    filter_.emplace(config_.filter, first_guess(readings));
    publish(readings);
    state_.contact = {true, true};
    for (const core::Leg leg : core::kAllLegs) filter_->add_foot(leg, see(leg, readings.q));
    return state_;
  }
  filter_->propagate(readings.w_WB_B, readings.f_B, dt,
                     {creep(core::Leg::left, readings), creep(core::Leg::right, readings)});
  publish(readings);
  use_feet(readings, expected, dt);
  check_flight(readings, dt);
  publish(readings);
  return state_;
}

void StateEstimator::correct_height(double height) noexcept {
  if (!filter_) return;
  for (const core::Leg leg : core::kAllLegs) {
    if (!filter_->stands(leg)) continue;
    ++(filter_->correct_height(leg, height) ? counts_.heights_used : counts_.heights_refused);
  }
}

}  // namespace hopscotch::control
