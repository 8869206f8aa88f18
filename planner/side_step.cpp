#include "planner/side_step.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"
#include "planner/straight_knot.hpp"

namespace hopscotch::planner {

namespace {

/// Long enough that the legs share the load about evenly, short enough that the CoM has not moved
/// far from between the feet when it is needed most.
constexpr double kTakeoffRamp = 0.25;  // [s]
constexpr double kLandingRamp = 0.25;  // [s]

/// From 0 to 1 with the acceleration 6 s (1 - s): speed and distance in units of the ramp.
struct Ramp {
  double s = 0.0;
  [[nodiscard]] double acceleration() const { return 6.0 * s * (1.0 - s); }
  [[nodiscard]] double speed() const { return s * s * (3.0 - 2.0 * s); }
  [[nodiscard]] double distance() const { return s * s * s * (1.0 - 0.5 * s); }
};

/// Quintic from 0 to 1 that starts and ends at rest without acceleration, and its slope.
double blend(double s) {
  return s * s * s * (10.0 + s * (6.0 * s - 15.0));
}
double blend_slope(double s) {
  return 30.0 * s * s * (1.0 - s) * (1.0 - s);
}

}  // namespace

SideStep::SideStep(const PlanarModel& model, const PlanarMotion& motion, double lateral, double yaw)
    : liftoff_(motion.liftoff_time),
      touchdown_(motion.touchdown_time),
      lateral_(lateral),
      yaw_(yaw),
      target_(motion.target_ankle.x - model.ankle_x(), lateral) {
  const double ramp = std::min(kTakeoffRamp, liftoff_);
  takeoff_from_ = liftoff_ - ramp;
  landing_ramp_ = std::min(kLandingRamp, motion.knots.back().time - touchdown_);
  const double flight = touchdown_ - liftoff_;
  const double effective = 0.5 * ramp + flight + 0.5 * landing_ramp_;
  measure_turn(model, motion);
  find_turn();
  // Where and how fast the flight ends in the plane of S, and where the landing, laid about the
  // target, wants to begin.
  const Eigen::Vector2d along(motion.liftoff_velocity.x, 0.0);
  const Eigen::Vector2d end(motion.liftoff_com.x + motion.liftoff_velocity.x * flight, 0.0);
  const Eigen::Rotation2Dd turn(yaw);
  const Eigen::Vector2d ahead(end.x() - target_.x(), 0.0);
  const Eigen::Vector2d wanted = target_ + turn * ahead;
  const Eigen::Vector2d turned = turn * along;
  velocity_ = (wanted - end - 0.5 * landing_ramp_ * (along - turned)) / effective;
  remaining_ = along + velocity_ - turned;
}

namespace {

/// Vertical angular momentum of the straight posture with these yaw rates of trunk and hips.
double vertical_momentum(const PlanarModel& model, const PlanarInstant& now, double of_trunk,
                         double of_hips) {
  const core::JumpKnot straight = straight_knot(model, now);
  core::RobotState state;
  state.p_WB = straight.p_WB;
  state.R_WB = model::rotation_from_rpy(straight.rpy);
  state.v_WB.setZero();
  state.q = straight.q;
  state.w_WB = {0.0, 0.0, of_trunk};
  state.dq.setZero();
  for (const core::Leg leg : core::kAllLegs) {
    state.dq(core::joint_index(leg, core::Joint::hip_yaw)) = of_hips;
  }
  return model::composite_body(model.robot, state).momentum_W.z();
}

}  // namespace

/// The trunk turning over soles that keep their heading, and the legs turning under a still trunk.
void SideStep::measure_turn(const PlanarModel& model, const PlanarMotion& motion) {
  const double flight = touchdown_ - liftoff_;
  const auto measure = [&](const PlanarKnot& knot, double elapsed) {
    const PlanarInstant now = instant(model, motion, knot, elapsed);
    const double s = std::clamp((knot.time + elapsed - liftoff_) / flight, 0.0, 1.0);
    trunk_inertia_.push_back(vertical_momentum(model, now, 1.0, -1.0));
    other_momentum_.push_back(vertical_momentum(model, now, 0.0, 1.0) * blend_slope(s) / flight *
                              yaw_);
  };
  const auto first = static_cast<std::size_t>(model.config.steps.takeoff);
  const std::size_t end = first + static_cast<std::size_t>(model.config.steps.flight);
  for (std::size_t i = first; i < end; ++i) {
    measure(motion.knots[i], 0.0);
    measure(motion.knots[i], 0.5 * motion.knots[i].dt);
  }
  measure(motion.knots[end - 1], motion.knots[end - 1].dt);
  flight_yaw_.resize(trunk_inertia_.size());
  flight_yaw_rate_.resize(trunk_inertia_.size());
}

/// The momentum with which the trunk has the target's heading when the landing's ramp is over:
/// lift-off turns the trunk over feet that stand, the legs' turn takes some of it back.
void SideStep::find_turn() {
  const std::size_t last = trunk_inertia_.size() - 1;
  const double h = (touchdown_ - liftoff_) / static_cast<double>(last);
  double per_momentum = 0.0;  // heading per unit of momentum
  double taken_back = 0.0;
  for (std::size_t i = 0; i <= last; ++i) {
    double weight = i == 0 || i == last ? 0.5 * h : h;
    if (i == 0) weight += 0.5 * (liftoff_ - takeoff_from_);
    if (i == last) weight += 0.5 * landing_ramp_;
    per_momentum += weight / trunk_inertia_[i];
    taken_back += weight * other_momentum_[i] / trunk_inertia_[i];
  }
  const double momentum = (yaw_ + taken_back) / per_momentum;
  for (std::size_t i = 0; i <= last; ++i) {
    flight_yaw_rate_[i] = (momentum - other_momentum_[i]) / trunk_inertia_[i];
    flight_yaw_[i] =
        i == 0 ? 0.5 * (liftoff_ - takeoff_from_) * flight_yaw_rate_[0]
               : flight_yaw_[i - 1] + 0.5 * h * (flight_yaw_rate_[i - 1] + flight_yaw_rate_[i]);
  }
  liftoff_yaw_rate_ = flight_yaw_rate_.front();
  touchdown_yaw_rate_ = flight_yaw_rate_.back();
}

void SideStep::account_for(const std::vector<double>& momentum) {
  for (std::size_t i = 0; i < other_momentum_.size(); ++i) {
    other_momentum_[i] = momentum[i] - trunk_inertia_[i] * flight_yaw_rate_[i];
  }
  find_turn();
}

void SideStep::set_flight(double coasting, SideShift& now) const {
  const double flight = touchdown_ - liftoff_;
  const double s = std::clamp(coasting / flight, 0.0, 1.0);
  now.sole_y = blend(s) * lateral_;
  now.sole_y_rate = blend_slope(s) / flight * lateral_;
  now.sole_yaw = blend(s) * yaw_;
  now.sole_yaw_rate = blend_slope(s) / flight * yaw_;
  const double place = s * static_cast<double>(flight_yaw_.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), flight_yaw_.size() - 2);
  const double share = place - static_cast<double>(i);
  now.yaw = (1.0 - share) * flight_yaw_[i] + share * flight_yaw_[i + 1];
  now.yaw_rate = (1.0 - share) * flight_yaw_rate_[i] + share * flight_yaw_rate_[i + 1];
}

SideShift SideStep::at(double time, core::JumpPhase phase) const {
  SideShift now;
  if (phase == core::JumpPhase::landing) {
    const Ramp left{1.0 - std::clamp((time - touchdown_) / landing_ramp_, 0.0, 1.0)};
    now.shift = -landing_ramp_ * left.distance() * remaining_;
    now.velocity = left.speed() * remaining_;
    now.acceleration = -left.acceleration() / landing_ramp_ * remaining_;
    now.yaw = yaw_ - landing_ramp_ * left.distance() * touchdown_yaw_rate_;
    now.yaw_rate = left.speed() * touchdown_yaw_rate_;
    now.yaw_acceleration = -left.acceleration() / landing_ramp_ * touchdown_yaw_rate_;
    now.sole_y = lateral_;
    now.sole_yaw = now.plane_yaw = yaw_;
    return now;
  }
  const double ramp = liftoff_ - takeoff_from_;
  const Ramp done{std::clamp((time - takeoff_from_) / ramp, 0.0, 1.0)};
  const bool flight = phase == core::JumpPhase::flight;
  const double coasting = flight ? time - liftoff_ : 0.0;
  const double travelled = ramp * done.distance() + coasting;
  now.shift = travelled * velocity_;
  now.velocity = done.speed() * velocity_;
  if (flight) {
    set_flight(coasting, now);
    return now;
  }
  now.yaw = travelled * liftoff_yaw_rate_;
  now.yaw_rate = done.speed() * liftoff_yaw_rate_;
  now.acceleration = done.acceleration() / ramp * velocity_;
  now.yaw_acceleration = done.acceleration() / ramp * liftoff_yaw_rate_;
  return now;
}

Eigen::Vector3d SideStep::point(const model::PlanarVector<double>& p, core::JumpPhase phase) const {
  if (phase != core::JumpPhase::landing) return {p.x, 0.0, p.z};
  const Eigen::Vector2d turned =
      target_ + Eigen::Rotation2Dd(yaw_) * Eigen::Vector2d(p.x - target_.x(), 0.0);
  return {turned.x(), turned.y(), p.z};
}

}  // namespace hopscotch::planner
