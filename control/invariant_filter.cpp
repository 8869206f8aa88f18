#include "control/invariant_filter.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "model/gravity.hpp"
#include "model/kinematics.hpp"

namespace hopscotch::control {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Vector3d kGravity_W(0.0, 0.0, -model::kGravity);

Matrix3d rotation_of(const Vector3d& turn) {
  const double angle = turn.norm();
  if (angle < 1e-12) return Matrix3d::Identity() + model::skew(turn);
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

constexpr int sole_block(core::Leg leg) {
  return InvariantFilter::kSole + 3 * static_cast<int>(core::index(leg));
}

double square(double x) {
  return x * x;
}

/// A turn of B alone is, for the errors of the group, a turn of everything about W's origin.
using TurnOfAll = Eigen::Matrix<double, InvariantFilter::kGyroBias, 3>;
TurnOfAll turn_of_all(const FilterState& state, const std::array<bool, core::kLegs>& standing) {
  TurnOfAll turning = TurnOfAll::Zero();
  turning.middleRows<3>(InvariantFilter::kAttitude).setIdentity();
  turning.middleRows<3>(InvariantFilter::kVelocity) = model::skew(state.v_WB);
  turning.middleRows<3>(InvariantFilter::kPosition) = model::skew(state.p_WB);
  for (const core::Leg leg : core::kAllLegs) {
    if (!standing[core::index(leg)]) continue;
    turning.middleRows<3>(sole_block(leg)) = model::skew(state.p_WF[core::index(leg)]);
  }
  return turning;
}

/// As errors of the group, place and heading are tied: a turn found now would move a trunk that is
/// 80 m from W's origin by 80 m times its angle, although nothing was learnt of where it is. Where
/// the trunk comes down is where it is, as well as that is known, whatever its heading.
void untie_place(const Vector3d& p_WB, InvariantFilter::Covariance& P) {
  constexpr int kTurn = InvariantFilter::kAttitude;
  constexpr int kPlace = InvariantFilter::kPosition;
  const Matrix3d lever = model::skew(p_WB);
  const Matrix3d turn = P.block<3, 3>(kTurn, kTurn);
  const Matrix3d tied = lever * P.block<3, 3>(kTurn, kPlace);
  const Matrix3d of_place =
      P.block<3, 3>(kPlace, kPlace) - tied - tied.transpose() + lever * turn * lever.transpose();
  P.middleRows<3>(kPlace) = (lever * P.middleRows<3>(kTurn)).eval();
  P.middleCols<3>(kPlace) = P.middleRows<3>(kPlace).transpose().eval();
  P.block<3, 3>(kPlace, kPlace) = lever * turn * lever.transpose() + of_place;
}

}  // namespace

InvariantFilter::InvariantFilter(const FilterConfig& config, const FilterState& start)
    : config_(config), state_(start) {
  const auto set = [this](int block, double sigma) {
    covariance_.diagonal().segment<3>(block).setConstant(square(sigma));
  };
  set(kVelocity, config.start_speed_sigma);
  set(kGyroBias, config.gyro_bias_sigma);
  set(kForceBias, config.accelerometer_bias_sigma);
  // Place and speed are believed whatever the attitude: as errors of the group they turn with it.
  // The heading places W; what a wrong tilt makes of it is of second order.
  const double tilt = config.start_tilt_sigma;
  const Vector3d attitude(square(tilt), square(tilt), square(square(tilt)));
  const TurnOfAll turning = turn_of_all(state_, standing_);
  covariance_.topLeftCorner<kGyroBias, kGyroBias>() +=
      turning * attitude.asDiagonal() * turning.transpose();
}

void InvariantFilter::propagate(const Vector3d& rate, const Vector3d& force, double dt,
                                const std::array<double, core::kLegs>& density) noexcept {
  move_covariance(dt);
  add_noise(force, dt, density);
  state_.R_WB = Eigen::Quaterniond(state_.R_WB * rotation_of(dt * (rate - state_.gyro_bias)))
                    .normalized()
                    .toRotationMatrix();
  state_.v_WB += dt * (state_.R_WB * (force - state_.accelerometer_bias) + kGravity_W);
  // The velocity after the step: the sum that mean accelerations of whole steps make.
  state_.p_WB += dt * state_.v_WB;
}

/// P <- Phi P Phi', Phi = I + A dt with the few blocks that A has.
void InvariantFilter::move_covariance(double dt) noexcept {
  const Matrix3d turn = dt * state_.R_WB;
  const Matrix3d fall = dt * model::skew(kGravity_W);
  const Matrix3d v_turn = model::skew(state_.v_WB) * turn;
  const Matrix3d p_turn = model::skew(state_.p_WB) * turn;
  const auto half_step = [&](auto&& row) {
    row(kPosition) += dt * row(kVelocity) - p_turn * row(kGyroBias);
    row(kVelocity) += fall * row(kAttitude) - v_turn * row(kGyroBias) - turn * row(kForceBias);
    row(kAttitude) -= turn * row(kGyroBias);
    for (const core::Leg leg : core::kAllLegs) {
      if (!stands(leg)) continue;
      const Vector3d& p_WF = state_.p_WF[core::index(leg)];
      row(sole_block(leg)) -= model::skew(p_WF) * (turn * row(kGyroBias));
    }
  };
  half_step([this](int block) { return covariance_.middleRows<3>(block); });
  covariance_.transposeInPlace();
  half_step([this](int block) { return covariance_.middleRows<3>(block); });
}

void InvariantFilter::add_noise(const Vector3d& force, double dt,
                                const std::array<double, core::kLegs>& density) noexcept {
  const TurnOfAll turning = turn_of_all(state_, standing_);
  for (const core::Leg leg : core::kAllLegs) {
    if (!stands(leg)) continue;
    covariance_.diagonal().segment<3>(sole_block(leg)).array() +=
        square(density[core::index(leg)]) * dt;
  }
  covariance_.topLeftCorner<kGyroBias, kGyroBias>().noalias() +=
      (square(config_.gyro_density) * dt) * turning * turning.transpose();
  double force_variance = square(config_.accelerometer_density) * dt;
  if (force.cwiseAbs().maxCoeff() >= config_.accelerometer_range) {
    force_variance += square(config_.saturated_sigma * dt);
  }
  covariance_.diagonal().segment<3>(kVelocity).array() += force_variance;
  covariance_.diagonal().segment<3>(kGyroBias).array() += square(config_.gyro_walk) * dt;
  covariance_.diagonal().segment<3>(kForceBias).array() += square(config_.accelerometer_walk) * dt;
}

void InvariantFilter::add_foot(core::Leg leg, const SeenFoot& seen) noexcept {
  if (!stands(core::Leg::left) && !stands(core::Leg::right)) untie_place(state_.p_WB, covariance_);
  const int sole = sole_block(leg);
  state_.p_WF[core::index(leg)] = state_.p_WB + state_.R_WB * seen.p_BF;
  covariance_.middleRows<3>(sole) = covariance_.middleRows<3>(kPosition);
  covariance_.middleCols<3>(sole) = covariance_.middleCols<3>(kPosition);
  covariance_.block<3, 3>(sole, sole) = covariance_.block<3, 3>(kPosition, kPosition) +
                                        state_.R_WB * seen.covariance * state_.R_WB.transpose() +
                                        square(config_.foot_sigma) * Matrix3d::Identity();
  standing_[core::index(leg)] = true;
}

void InvariantFilter::remove_foot(core::Leg leg) noexcept {
  standing_[core::index(leg)] = false;
  covariance_.middleRows<3>(sole_block(leg)).setZero();
  covariance_.middleCols<3>(sole_block(leg)).setZero();
}

FootVerdict InvariantFilter::correct_foot(core::Leg leg, const SeenFoot& seen) noexcept {
  const int sole = sole_block(leg);
  const Vector3d residual = state_.R_WB * seen.p_BF - (state_.p_WF[core::index(leg)] - state_.p_WB);
  const Eigen::Matrix<double, kSize, 3> PH =
      covariance_.middleCols<3>(kPosition) - covariance_.middleCols<3>(sole);
  const Matrix3d S = PH.middleRows<3>(kPosition) - PH.middleRows<3>(sole) +
                     state_.R_WB * seen.covariance * state_.R_WB.transpose() +
                     square(config_.foot_sigma) * Matrix3d::Identity();
  const Matrix3d S_inverse = S.inverse();
  if (!(residual.dot(S_inverse * residual) <= config_.gate)) {
    remove_foot(leg);
    add_foot(leg, seen);
    return FootVerdict::slipped;
  }
  const Eigen::Matrix<double, kSize, 3> gain = PH * S_inverse;
  apply(gain * residual);
  covariance_.noalias() -= gain * PH.transpose();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  return FootVerdict::fits;
}

void InvariantFilter::doubt_flight(const FlightError& error) noexcept {
  // A constant error of the accelerometer, in flight; the speed that it left went on after it. The
  // soles are where the legs say they are below the trunk, and so as wrong as it is.
  const double height = error.rise_speed * (0.5 * error.flown + error.stood);
  Eigen::Vector<double, kSize> wrong = Eigen::Vector<double, kSize>::Zero();
  wrong(kVelocity + 2) = error.rise_speed;
  wrong(kPosition + 2) = height;
  for (const core::Leg leg : core::kAllLegs) {
    if (stands(leg)) wrong(sole_block(leg) + 2) = height;
  }
  covariance_.noalias() += wrong * wrong.transpose();
}

bool InvariantFilter::correct_height(core::Leg leg, double height) noexcept {
  const int sole = sole_block(leg);
  const Vector3d& p_WF = state_.p_WF[core::index(leg)];
  // height of the sole = z of its error plus what the attitude's error turns into height
  const Eigen::Vector3d lever(p_WF.y(), -p_WF.x(), 0.0);
  const Eigen::Vector<double, kSize> PH =
      covariance_.col(sole + 2) + covariance_.middleCols<3>(kAttitude) * lever;
  const double S =
      PH(sole + 2) + lever.dot(PH.segment<3>(kAttitude)) + square(config_.height_sigma);
  const double residual = p_WF.z() - height;
  if (!(square(residual) <= config_.height_gate * S)) return false;
  apply(PH * (residual / S));
  covariance_.noalias() -= PH * (PH / S).transpose();
  return true;
}

/// Takes an estimated error off the state.
void InvariantFilter::apply(const Eigen::Vector<double, kSize>& error) noexcept {
  const Vector3d turn = -error.segment<3>(kAttitude);
  const Matrix3d rotation = rotation_of(turn);
  // The group's exponential to first order in the turn: corrections are small.
  const Matrix3d shift = Matrix3d::Identity() + 0.5 * model::skew(turn);
  const auto move = [&](Vector3d& x, int block) {
    x = rotation * x - shift * error.segment<3>(block);
  };
  state_.R_WB = rotation * state_.R_WB;
  move(state_.v_WB, kVelocity);
  move(state_.p_WB, kPosition);
  for (const core::Leg leg : core::kAllLegs) {
    if (stands(leg)) move(state_.p_WF[core::index(leg)], sole_block(leg));
  }
  state_.gyro_bias -= error.segment<3>(kGyroBias);
  state_.accelerometer_bias -= error.segment<3>(kForceBias);
}

}  // namespace hopscotch::control
