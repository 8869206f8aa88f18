#include "control/disturbed_flight.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "control/plan_follower.hpp"
#include "model/kinematics.hpp"
#include "model/knot_state.hpp"
#include "model/rigid_body.hpp"

namespace hopscotch::control {

namespace {

using core::Joint;
using core::joint_index;

/// What exceeds `dead` of a deviation.
double beyond(double deviation, double dead) {
  return std::copysign(std::max(0.0, std::abs(deviation) - dead), deviation);
}

/// Whether a flight is disturbed: 0 within what trunks of undisturbed jumps turn beside their plan,
/// 1 from twice that on.
double disturbance(double turned) {
  constexpr double kScatter = 0.06;  // [rad]
  return std::clamp(std::abs(turned) / kScatter - 1.0, 0.0, 1.0);
}

double square(double x) {
  return x * x;
}

/// The ankle from the hip, ahead and down [m].
struct Reach {
  double ahead, down;
};

/// @param a, b Lengths of thigh and shank [m]. @param thigh Its angle from the vertical, + knee
/// behind. @param knee Angle [rad].
Reach reach_of(double a, double b, double thigh, double knee) {
  return {-a * std::sin(thigh) - b * std::sin(thigh + knee),
          a * std::cos(thigh) + b * std::cos(thigh + knee)};
}

/// How the thigh turns per distance that the ankle goes straight down [rad/m].
double thigh_rate(double a, double b, double thigh, double knee) {
  // d(ahead) = 0, d(down) = 1 over the two angles.
  const double shank = thigh + knee;
  return -b * std::cos(shank) / (a * b * std::sin(-knee));
}

double mid_sole_height(const model::RobotParameters& robot, const core::RobotState& state) {
  const auto soles = model::sole_poses(robot, state);
  return 0.5 * (soles[0].translation().z() + soles[1].translation().z());
}

/// A CoM that flies faster than planned, after a push or a slip, needs the feet further on when it
/// lands: by the speed times the time constant of the pendulum it then is. The legs turn about the
/// hips, the ankles keep the soles level.
/// @param planned Where the body should be now.
void place_feet(const JointGains& gains, const model::RobotParameters& robot,
                const core::RobotState& state, const core::JumpKnot& planned,
                core::JointVector& q) {
  const Eigen::AngleAxisd in_S(-planned.rpy.z(), Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d excess = in_S * (model::composite_body(robot, state).v_WG - planned.v_WG);
  const double length = planned.p_WB.z() - mid_sole_height(robot, model::state_of(planned));
  const auto angle = [&](double speed) {
    const double shift = gains.placement_time * beyond(speed, gains.placement_dead);
    return std::clamp(shift, -gains.placement_max, gains.placement_max) / length;
  };
  const double forward = angle(excess.x());
  const double left = angle(excess.y());
  for (const core::Leg leg : core::kAllLegs) {
    q[joint_index(leg, Joint::hip_pitch)] -= forward;
    q[joint_index(leg, Joint::ankle)] += forward;
    q[joint_index(leg, Joint::hip_roll)] += left;
  }
}

/// How far the legs reach down beside the plan at a time of it, for a trunk that has turned beside
/// the plan by `turned` [rad]: 0 to `stretch_max` [m].
double stretch_in_flight(const JointGains& gains, const PlanMoment& moment, double turned) {
  // Before, the soles are on their way over the ground.
  constexpr double kFrom = 0.5;  // of the flight
  constexpr double kTo = 0.75;   // all of it
  const double flown = (moment.time - moment.plan.liftoff_time) /
                       (moment.plan.touchdown_time - moment.plan.liftoff_time);
  const double share = std::clamp((flown - kFrom) / (kTo - kFrom), 0.0, 1.0);
  const double wanted = gains.stretch_per_turn * std::abs(beyond(turned, gains.stretch_dead));
  return share * std::min(wanted, gains.stretch_max);
}

/// A place over the ground, in the frame S of a jump [m].
struct Over {
  double x, z;
};

Over over_ground(const core::LandingTarget& target, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d off = p_W - target.p_WS;
  return {off.x() * std::cos(target.heading) + off.y() * std::sin(target.heading), off.z()};
}

/// How far a sole may go straight down before it reaches into what stands up before the landing
/// place, the edge of a step that it is still on its way over [m]; no limit where there is nothing
/// under it and ahead but the ground that it is to meet.
double room_below(const core::LandingTarget& target, const model::SoleTips& tips) {
  constexpr double kAhead = 0.08;    // way that a sole still makes while a leg could be folded [m]
  constexpr double kSame = 0.03;     // the ground to land on, sloping [m]
  constexpr double kMargin = 0.015;  // [m]
  using Profile = core::TerrainProfile;
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  const Over heel = over_ground(target, tips.heel);
  const Over toe = over_ground(target, tips.toe);
  if (!std::isfinite(heel.x + toe.x + heel.z + toe.z + target.height)) return kNoLimit;
  double highest = -kNoLimit;
  double lowest = kNoLimit;
  for (int i = Profile::sample(heel.x); i <= Profile::sample(toe.x + kAhead); ++i) {
    const auto at = static_cast<std::size_t>(i);
    highest = std::max(highest, target.profile.upper[at]);
    lowest = std::min(lowest, target.profile.mean[at]);
  }
  if (highest < target.height + kSame && lowest > target.height - kSame) return kNoLimit;
  return std::max(0.0, std::min(heel.z, toe.z) - highest - kMargin);
}

/// The same of both soles with the legs at such angles.
double room_below(const model::RobotParameters& robot, const core::RobotState& state,
                  const core::LandingTarget& target, const core::JointVector& q) {
  core::RobotState aimed = state;
  aimed.q = q;
  const auto soles = model::sole_poses(robot, aimed);
  return std::min(room_below(target, model::sole_tips(robot, soles[0])),
                  room_below(target, model::sole_tips(robot, soles[1])));
}

/// Hips at their stops would meet the ground stiff. What a hip cannot turn, the ankle does: the
/// soles stay level.
void spare_hip_stops(const model::RobotParameters& robot, core::JointVector& q) {
  constexpr double kRoom = 0.05;  // [rad]
  for (const core::Leg leg : core::kAllLegs) {
    const model::JointRange range = model::joint_range(robot, leg, Joint::hip_pitch);
    double& hip = q[joint_index(leg, Joint::hip_pitch)];
    const double possible = std::clamp(hip, range.lower + kRoom, range.upper - kRoom);
    q[joint_index(leg, Joint::ankle)] += hip - possible;
    hip = possible;
  }
}

}  // namespace

void stretch_each_leg(const model::RobotParameters& robot, double pitch,
                      const std::array<Stretch, core::kLegs>& stretches, core::JointVector& q,
                      core::JointVector& dq) noexcept {
  constexpr double kStraightest = -0.5;  // of the knee: its range ends at -0.26 [rad]
  const double a = robot.thigh_length();
  const double b = robot.shank_length();
  for (const core::Leg leg : core::kAllLegs) {
    const Stretch& stretch = stretches[core::index(leg)];
    double& hip = q[joint_index(leg, Joint::hip_pitch)];
    double& knee = q[joint_index(leg, Joint::knee)];
    const Reach before = reach_of(a, b, pitch + hip, knee);
    const double longest = std::sqrt(a * a + b * b + 2.0 * a * b * std::cos(kStraightest));
    const double down = std::min(before.down + stretch.by,
                                 std::sqrt(std::max(0.0, square(longest) - square(before.ahead))));
    if (down <= 0.0) continue;
    const double length = std::hypot(before.ahead, down);
    const double cosine = (square(length) - a * a - b * b) / (2.0 * a * b);
    const double bent = -std::acos(std::clamp(cosine, -1.0, 1.0));
    // From the leg's direction to that of its thigh, the knee being behind.
    const double thigh =
        -std::atan2(before.ahead, down) + std::atan2(-b * std::sin(bent), a + b * std::cos(bent));
    const double opening = stretch.rate * down / (-a * b * std::sin(bent));
    const double turning = stretch.rate * thigh_rate(a, b, thigh, bent);
    q[joint_index(leg, Joint::ankle)] += hip + knee - (thigh - pitch) - bent;
    dq[joint_index(leg, Joint::ankle)] -= turning + opening;
    hip = thigh - pitch;
    knee = bent;
    dq[joint_index(leg, Joint::hip_pitch)] += turning;
    dq[joint_index(leg, Joint::knee)] += opening;
  }
}

void stretch_legs(const model::RobotParameters& robot, double pitch, const Stretch& stretch,
                  core::JointVector& q, core::JointVector& dq) noexcept {
  if (stretch.by == 0.0 && stretch.rate == 0.0) return;
  stretch_each_leg(robot, pitch, {stretch, stretch}, q, dq);
}

void keep_soles(const JointGains& gains, const core::RobotState& state,
                const core::JumpKnot& planned, core::JointVector& q) noexcept {
  const Eigen::Vector3d rpy = model::rpy_from_rotation(state.R_WB);
  const double pitch = rpy.y() - planned.rpy.y();
  // Legs of an undisturbed jump keep their planned directions: further on they land too far.
  const double further = (gains.flight_share - 1.0) * disturbance(pitch) * pitch;
  for (const core::Leg leg : core::kAllLegs) {
    q[joint_index(leg, Joint::hip_pitch)] -= pitch + further;
    q[joint_index(leg, Joint::ankle)] += further;
    q[joint_index(leg, Joint::hip_roll)] -= rpy.x() - planned.rpy.x();
  }
}

void aim_legs(const JointGains& gains, const model::RobotParameters& robot,
              const core::RobotState& state, const PlanMoment& moment,
              core::JointVector& q) noexcept {
  const core::JumpKnot planned = sample_plan(moment.plan, moment.time);
  const double pitch = model::rpy_from_rotation(state.R_WB).y();
  const double turned = pitch - planned.rpy.y();
  keep_soles(gains, state, planned, q);
  place_feet(gains, robot, state, planned, q);
  core::JointVector unused = core::JointVector::Zero();
  Stretch down{stretch_in_flight(gains, moment, turned), 0.0};
  if (down.by > 0.0) {
    down.by = std::min(down.by, room_below(robot, state, moment.plan.target, q));
  }
  stretch_legs(robot, pitch, down, q, unused);
  spare_hip_stops(robot, q);
}

namespace {

/// What a landing has beside its plan at the touchdown, and how that fades.
struct LandingOffset {
  double lean = 0.0;   // of the trunk's pitch [rad]
  double rise = 0.0;   // of the CoM above the soles [m]
  double climb = 0.0;  // of the CoM's vertical speed [m/s]

  struct At {
    double lean, lean_rate, rise, rise_rate;
  };
  /// @param time Since touchdown [s].
  [[nodiscard]] At at(double time) const {
    constexpr double kFadeTime = 0.25;  // [s]
    const double s = time / kFadeTime;
    if (s >= 1.0) return {0.0, 0.0, 0.0, 0.0};
    const double left = 1.0 + s * s * (2.0 * s - 3.0);
    const double left_rate = 6.0 * s * (s - 1.0) / kFadeTime;
    return {lean * left, lean * left_rate, rise * left + climb * time * (1.0 - s) * (1.0 - s),
            rise * left_rate + climb * (1.0 - s) * (1.0 - 3.0 * s)};
  }
};

LandingOffset landing_offset(const model::RobotParameters& robot, const core::RobotState& state,
                             const core::JumpKnot& planned) {
  const double planned_height = planned.p_WG.z() - mid_sole_height(robot, model::state_of(planned));
  const model::CompositeBody body = model::composite_body(robot, state);
  return {.lean = model::rpy_from_rotation(state.R_WB).y() - planned.rpy.y(),
          .rise = body.p_WG.z() - mid_sole_height(robot, state) - planned_height,
          .climb = body.v_WG.z() - planned.v_WG.z()};
}

/// What undisturbed jumps do not have at touchdown.
LandingOffset beyond_scatter(LandingOffset offset) {
  constexpr double kLean = 0.1;     // [rad]
  constexpr double kHeight = 0.01;  // [m]
  offset.lean = beyond(offset.lean, kLean);
  offset.rise = std::max(0.0, offset.rise - kHeight);
  // Longer legs are down before the body has gained all of its planned speed.
  offset.climb = offset.rise > 0.0 ? std::max(0.0, offset.climb) : 0.0;
  return offset;
}

void shape_knot(const model::RobotParameters& robot, const LandingOffset::At& beside,
                core::JumpKnot& knot) {
  const Eigen::AngleAxisd heading(knot.rpy.z(), Eigen::Vector3d::UnitZ());
  knot.rpy.y() += beside.lean;
  knot.w_WB += heading * Eigen::Vector3d(0.0, beside.lean_rate, 0.0);
  for (const core::Leg leg : core::kAllLegs) {
    knot.q[joint_index(leg, Joint::hip_pitch)] -= beside.lean;
    knot.dq[joint_index(leg, Joint::hip_pitch)] -= beside.lean_rate;
  }
  for (Eigen::Vector3d* place : {&knot.p_WB, &knot.p_WG}) place->z() += beside.rise;
  for (Eigen::Vector3d* speed : {&knot.v_WB, &knot.v_WG}) speed->z() += beside.rise_rate;
  stretch_legs(robot, knot.rpy.y(), {beside.rise, beside.rise_rate}, knot.q, knot.dq);
}

void add_to_landing(const model::RobotParameters& robot, const LandingOffset& offset, double time,
                    core::JumpPlan& plan) {
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    core::JumpKnot& knot = plan.knots[i];
    if (knot.phase != core::JumpPhase::landing || knot.time < time) continue;
    shape_knot(robot, offset.at(knot.time - time), knot);
  }
}

}  // namespace

bool shape_landing(const model::RobotParameters& robot, const core::RobotState& state,
                   core::JumpPlan& plan) noexcept {
  const core::JumpKnot touchdown = sample_plan(plan, plan.touchdown_time);
  const LandingOffset offset = beyond_scatter(landing_offset(robot, state, touchdown));
  if (offset.lean == 0.0 && offset.rise == 0.0) return false;
  add_to_landing(robot, offset, plan.touchdown_time, plan);
  return true;
}

void shape_after_impact(const model::RobotParameters& robot, const core::RobotState& state,
                        double time, core::JumpPlan& plan) noexcept {
  LandingOffset offset = landing_offset(robot, state, sample_plan(plan, time));
  offset.lean = 0.0;
  add_to_landing(robot, offset, time, plan);
}

}  // namespace hopscotch::control
