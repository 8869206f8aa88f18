#include "control/recovery_hop.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"

namespace hopscotch::control {

using core::Range;
using Soles = std::array<Eigen::Vector3d, core::kLegs>;

namespace {

constexpr std::size_t kPushSteps = 8;
constexpr std::size_t kFlightSteps = 10;
constexpr double kPushTimeMin = 0.06;     // [s]
constexpr double kPushTimeMax = 0.20;     // [s]
constexpr double kLandingTime = 0.4;      // [s]
constexpr double kUnloadHeightMin = 0.1;  // of the CoM over the soles; a body so low has fallen [m]

/// The robot in the frame of its soles: origin at their mid-point, x along them, z up.
struct Stance {
  Eigen::Vector3d origin;
  double yaw = 0.0;
  Eigen::Matrix3d R_SW;
  Eigen::Vector3d p_SG, v_SG;  ///< Of the CoM.
  Soles soles;                 ///< Sole centres in this frame.
  double toe = 0.0;            ///< Tip from the sole centre, along x and against it alike [m].

  Stance(const model::RobotParameters& robot, const core::RobotState& state) {
    const std::array<Eigen::Isometry3d, core::kLegs> X_WF = model::sole_poses(robot, state);
    const model::CompositeBody body = model::composite_body(robot, state);
    const Eigen::Vector3d forward = X_WF[0].linear().col(0) + X_WF[1].linear().col(0);
    origin = 0.5 * (X_WF[0].translation() + X_WF[1].translation());
    yaw = std::atan2(forward.y(), forward.x());
    R_SW = Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    p_SG = R_SW * (body.p_WG - origin);
    v_SG = R_SW * body.v_WG;
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      soles[leg] = R_SW * (X_WF[leg].translation() - origin);
    }
    toe = 0.5 * (robot.toe + robot.heel);
  }

  [[nodiscard]] double fall_time() const {
    return std::sqrt(std::max(p_SG.z(), 0.0) / model::kGravity);
  }
  [[nodiscard]] Eigen::Vector2d capture_point() const {
    return (p_SG + fall_time() * v_SG).head<2>();
  }
};

/// How the CoM moves in a hop and where the soles meet it, in the frame of the stance.
struct HopMotion {
  double push_time, flight_time;
  std::array<Eigen::Vector3d, kPushSteps + 1> p_G, v_G;  ///< At the knots of the push.
  Eigen::Vector3d acceleration;                          ///< Upward, of the push.
  Eigen::Vector2d pivot;                                 ///< Centre of pressure of the push.
  Eigen::Vector3d shift;                                 ///< Of the soles.
};

/// The push: constant acceleration upward, and about the pivot what a body without spin does.
HopMotion hop_motion(const RecoveryHopConfig& config, const Stance& stance) {
  HopMotion hop{};
  const Eigen::Vector2d capture = stance.capture_point();
  const double half_width = 0.5 * std::abs(stance.soles[0].y() - stance.soles[1].y());
  hop.pivot = {std::clamp(capture.x(), -stance.toe, stance.toe),
               std::clamp(capture.y(), -half_width, half_width)};
  const double gain = config.lift_speed - stance.v_SG.z();
  hop.push_time = std::clamp(gain / config.push_acceleration, kPushTimeMin, kPushTimeMax);
  hop.acceleration = {0.0, 0.0, gain / hop.push_time};
  hop.p_G[0] = stance.p_SG;
  hop.v_G[0] = stance.v_SG;
  const double dt = hop.push_time / static_cast<double>(kPushSteps);
  for (std::size_t i = 0; i < kPushSteps; ++i) {
    const Eigen::Vector3d& p = hop.p_G[i];
    const double stiffness =
        (model::kGravity + hop.acceleration.z()) / std::max(p.z(), kUnloadHeightMin);
    Eigen::Vector3d a = hop.acceleration;
    a.head<2>() = stiffness * (p.head<2>() - hop.pivot);
    hop.v_G[i + 1] = hop.v_G[i] + dt * a;
    hop.p_G[i + 1] = p + dt * hop.v_G[i] + 0.5 * dt * dt * a;
  }
  const Eigen::Vector3d& p = hop.p_G[kPushSteps];
  const Eigen::Vector3d& v = hop.v_G[kPushSteps];
  const double drop = std::max(p.z() - config.landing_height, 0.0);
  hop.flight_time =
      (v.z() + std::sqrt(v.z() * v.z() + 2.0 * model::kGravity * drop)) / model::kGravity;
  const double fall_time = std::sqrt(config.landing_height / model::kGravity);
  const Eigen::Vector2d reach = (config.reach_share * fall_time * v.head<2>())
                                    .cwiseMax(-config.reach_max)
                                    .cwiseMin(config.reach_max);
  hop.shift << p.head<2>() + hop.flight_time * v.head<2>() + reach, 0.0;
  return hop;
}

/// Legs and trunk of a knot such that its CoM is at `p_WG` while the soles stay level at `soles`,
/// all in W. Sideways the legs turn about the hips. False if the legs are too short.
bool pose_knot(const model::RobotParameters& robot, const Soles& soles, core::JumpKnot& knot) {
  constexpr int kIterations = 4;  // each leaves about a quarter of the error
  core::RobotState posed;
  posed.R_WB = model::rotation_from_rpy(knot.rpy);
  posed.v_WB.setZero();
  posed.w_WB.setZero();
  posed.dq.setZero();
  posed.q.setZero();
  posed.p_WB = knot.p_WG + Eigen::Vector3d(0.0, 0.0, 0.145);
  for (int i = 0; i < kIterations; ++i) {
    for (const core::Leg leg : core::kAllLegs) {
      const Eigen::Vector3d p_BF = posed.R_WB.transpose() * (soles[core::index(leg)] - posed.p_WB);
      const auto q = model::leg_inverse_kinematics(robot, p_BF, -knot.rpy.y());
      if (!q) return false;
      posed.q.segment<core::kJointsPerLeg>(core::leg_offset(leg)) = *q;
    }
    posed.p_WB += knot.p_WG - model::composite_body(robot, posed).p_WG;
  }
  // The closed form has legs without roll: what they lack sideways is an angle at the hip.
  const std::array<Eigen::Isometry3d, core::kLegs> X_WF = model::sole_poses(robot, posed);
  const Eigen::Vector3d left = posed.R_WB.col(1);
  for (const core::Leg leg : core::kAllLegs) {
    const std::size_t i = core::index(leg);
    const double lacks = left.dot(soles[i] - X_WF[i].translation());
    const double length = posed.p_WB.z() - soles[i].z();
    posed.q[core::joint_index(leg, core::Joint::hip_roll)] = lacks / length;
  }
  knot.p_WB = posed.p_WB;
  knot.q = posed.q;
  return true;
}

double smooth(double s) {
  return s * s * (3.0 - 2.0 * s);
}

/// Writes the knots of a hop in order.
class HopWriter {
 public:
  HopWriter(const RecoveryHopConfig& config, const model::RobotParameters& robot,
            const core::RobotState& state, core::JumpPlan& plan)
      : config_(config),
        robot_(robot),
        stance_(robot, state),
        hop_(hop_motion(config, stance_)),
        R_WS_(stance_.R_SW.transpose()),
        pitch_(model::rpy_from_rotation(state.R_WB).y()),
        pitch_rate_(state.w_WB.dot(R_WS_.col(1))),
        plan_(plan) {
    plan_.knot_count = 0;
  }

  [[nodiscard]] const HopMotion& motion() const { return hop_; }
  [[nodiscard]] Soles soles_at(double share) const {
    Soles soles;
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      const double lift = config_.clearance * std::pow(std::sin(M_PI * share), 2);
      soles[leg] =
          stance_.origin + R_WS_ * (stance_.soles[leg] + smooth(share) * hop_.shift +
                                    Eigen::Vector3d(0.0, 0.0, lift - stance_.soles[leg].z()));
    }
    return soles;
  }

  /// The trunk's turning fades away while the feet are on the ground.
  bool write_push() {
    const double dt = hop_.push_time / static_cast<double>(kPushSteps);
    for (std::size_t i = 0; i < kPushSteps; ++i) {
      const double t = dt * static_cast<double>(i);
      const double left = 1.0 - t / hop_.push_time;
      core::JumpKnot& knot = next(core::JumpPhase::takeoff, t, dt);
      knot.contact = {true, true};
      move(hop_.p_G[i], hop_.v_G[i], knot);
      turn(pitch_ + 0.5 * pitch_rate_ * hop_.push_time * (1.0 - left * left), pitch_rate_ * left,
           knot);
      const Eigen::Vector3d a = (hop_.v_G[i + 1] - hop_.v_G[i]) / dt;
      set_wrenches(a, knot);
      if (!pose_knot(robot_, soles_at(0.0), knot)) return false;
    }
    return true;
  }

  bool write_flight() {
    const double dt = hop_.flight_time / static_cast<double>(kFlightSteps);
    for (std::size_t i = 0; i < kFlightSteps; ++i) {
      const double t = dt * static_cast<double>(i);
      core::JumpKnot& knot = next(core::JumpPhase::flight, hop_.push_time + t, dt);
      knot.contact = {false, false};
      if (!ballistic(t, knot)) return false;
    }
    return true;
  }

  /// Touchdown, and the stand over it: how to get from one to the other is settled when the feet
  /// are there.
  bool write_landing(const StandTarget& stand) {
    const double touchdown = hop_.push_time + hop_.flight_time;
    core::JumpKnot& knot = next(core::JumpPhase::landing, touchdown, kLandingTime);
    if (!ballistic(hop_.flight_time, knot)) return false;
    knot.contact = {true, true};
    set_wrenches(Eigen::Vector3d::Zero(), knot);
    const core::JumpKnot landed = knot;
    core::JumpKnot& last = next(core::JumpPhase::landing, touchdown + kLandingTime, 0.0);
    last = landed;
    last.time = touchdown + kLandingTime;
    last.dt = 0.0;
    last.v_WG.setZero();
    const Soles soles = soles_at(1.0);
    last.p_WG.head<2>() = 0.5 * (soles[0] + soles[1]).head<2>();
    last.rpy.y() = stand.pitch;
    last.w_WB.setZero();
    if (!pose_knot(robot_, soles, last)) return false;
    last.dq.setZero();
    last.v_WB.setZero();
    return true;
  }

  /// Rates of joints and trunk from the places at the knots.
  void differentiate() {
    for (std::size_t i = 0; i + 1 < plan_.knot_count; ++i) {
      const core::JumpKnot& a = plan_.knots[i == 0 ? 0 : i - 1];
      const core::JumpKnot& b = plan_.knots[i + 1];
      const bool last =
          b.time - plan_.knots[i].time > 2.0 * (plan_.knots[i].time - a.time) && i > 0;
      const core::JumpKnot& to = last ? plan_.knots[i] : b;
      plan_.knots[i].dq = (to.q - a.q) / (to.time - a.time);
      plan_.knots[i].v_WB = (to.p_WB - a.p_WB) / (to.time - a.time);
    }
  }

 private:
  core::JumpKnot& next(core::JumpPhase phase, double time, double dt) {
    core::JumpKnot& knot = plan_.knots[plan_.knot_count++];
    knot = {};
    knot.phase = phase;
    knot.time = time;
    knot.dt = dt;
    knot.tau.setZero();
    knot.wrenches = {};
    return knot;
  }
  void move(const Eigen::Vector3d& p_SG, const Eigen::Vector3d& v_SG, core::JumpKnot& knot) const {
    knot.p_WG = stance_.origin + R_WS_ * p_SG;
    knot.v_WG = R_WS_ * v_SG;
  }
  void turn(double pitch, double rate, core::JumpKnot& knot) const {
    knot.rpy = {0.0, pitch, stance_.yaw};
    knot.w_WB = rate * R_WS_.col(1);
  }
  void set_wrenches(const Eigen::Vector3d& acceleration, core::JumpKnot& knot) const {
    const Eigen::Vector3d force =
        0.5 * robot_.total_mass() * (acceleration + Eigen::Vector3d(0.0, 0.0, model::kGravity));
    for (core::Wrench& wrench : knot.wrenches) {
      wrench.force = R_WS_ * force;
      wrench.moment = R_WS_ * Eigen::Vector3d(0.0, -hop_.pivot.x() * force.z(), 0.0);
    }
  }
  bool ballistic(double t, core::JumpKnot& knot) const {
    const Eigen::Vector3d gravity(0.0, 0.0, -model::kGravity);
    const Eigen::Vector3d& v = hop_.v_G[kPushSteps];
    move(hop_.p_G[kPushSteps] + t * v + 0.5 * t * t * gravity, v + t * gravity, knot);
    turn(pitch_ + 0.5 * pitch_rate_ * hop_.push_time, 0.0, knot);
    return pose_knot(robot_, soles_at(std::min(t / hop_.flight_time, 1.0)), knot);
  }

  const RecoveryHopConfig& config_;
  const model::RobotParameters& robot_;
  Stance stance_;
  HopMotion hop_;
  Eigen::Matrix3d R_WS_;
  double pitch_, pitch_rate_;
  core::JumpPlan& plan_;
};

}  // namespace

RecoveryHopConfig RecoveryHopConfig::load(const core::ConfigReader& section) {
  RecoveryHopConfig config;
  config.excess_along = section.number("excess_along_m", Range::closed(-0.05, 0.2));
  config.excess_across = section.number("excess_across_m", Range::closed(-0.05, 0.2));
  config.wait = section.number("wait_s", Range::closed(0.0, 1.0));
  config.lift_speed = section.number("lift_speed_mps", Range::closed(0.3, 1.5));
  config.push_acceleration = section.number("push_acceleration_mps2", Range::closed(2.0, 30.0));
  config.clearance = section.number("clearance_m", Range::closed(0.0, 0.1));
  config.landing_height = section.number("landing_height_m", Range::closed(0.25, 0.42));
  config.reach_share = section.number("reach_share", Range::closed(0.0, 2.0));
  config.reach_max = section.number("reach_max_m", Range::closed(0.0, 0.2));
  section.finish();
  return config;
}

Eigen::Vector2d capture_point(const model::RobotParameters& robot,
                              const core::RobotState& state) noexcept {
  return Stance(robot, state).capture_point();
}

bool must_hop(const RecoveryHopConfig& config, const model::RobotParameters& robot,
              const core::RobotState& state) noexcept {
  const Stance stance(robot, state);
  const Eigen::Vector2d capture = stance.capture_point();
  const double half_width = 0.5 * std::abs(stance.soles[0].y() - stance.soles[1].y());
  return std::abs(capture.x()) > stance.toe + config.excess_along ||
         std::abs(capture.y()) > half_width + config.excess_across;
}

bool make_recovery_hop(const RecoveryHopConfig& config, const model::RobotParameters& robot,
                       const core::RobotState& state, const StandTarget& stand,
                       core::JumpPlan& plan) noexcept {
  plan.id = 0;
  plan.stamp = state.stamp;
  plan.status = core::PlanStatus::solved;
  HopWriter writer(config, robot, state, plan);
  if (!writer.write_push() || !writer.write_flight() || !writer.write_landing(stand)) return false;
  writer.differentiate();
  plan.liftoff_time = writer.motion().push_time;
  plan.touchdown_time = plan.liftoff_time + writer.motion().flight_time;
  plan.duration = plan.touchdown_time + kLandingTime;
  plan.target = {};
  const Soles soles = writer.soles_at(1.0);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    plan.target.X_WF[leg] = Eigen::Translation3d(soles[leg]);
  }
  return true;
}

}  // namespace hopscotch::control
