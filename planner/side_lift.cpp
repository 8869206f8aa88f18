#include "planner/side_lift.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "model/kinematics.hpp"
#include "model/knot_state.hpp"
#include "model/rigid_body.hpp"
#include "planner/leg_placement.hpp"
#include "planner/straight_knot.hpp"

namespace hopscotch::planner {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Each pass moves the trunk by how far the CoM of the whole robot is off; the legs follow with a
/// third of the mass at a third of the distance, so an error shrinks tenfold.
constexpr int kCentringPasses = 8;
/// Largest moment of a foot about the vertical, per newton of its load: half of what its toe and
/// heel can hold by friction [m].
constexpr double kFootYawArm = 0.02;

Matrix3d about_z(double yaw) {
  return Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
}

/// Where the soles go, from where they are in the straight motion.
std::array<SoleMotion, core::kLegs> sole_motions(const PlanarModel& model, const SideStep& step,
                                                 const PlanarInstant& now, const SideShift& shift,
                                                 const core::JumpKnot& straight) {
  const auto soles = model::sole_poses(model.robot, model::state_of(straight));
  const Vector3d middle = 0.5 * (soles[0].translation() + soles[1].translation());
  const Vector3d ankle(now.ankle.x, 0.0, now.ankle.z);
  const Vector3d foot_rate(0.0, now.links.rate[model::kFoot], 0.0);
  const Vector3d planar_velocity =
      Vector3d(now.ankle_velocity.x, 0.0, now.ankle_velocity.z) + foot_rate.cross(middle - ankle);
  const Matrix3d turn = about_z(shift.sole_yaw);
  const Vector3d spin(0.0, 0.0, shift.sole_yaw_rate);
  Vector3d place = step.point({middle.x(), middle.z()}, now.phase);
  if (now.phase == core::JumpPhase::flight) place.y() += shift.sole_y;
  std::array<SoleMotion, core::kLegs> motions;
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    const Vector3d offset = turn * (soles[leg].translation() - middle);
    motions[leg].X_WF.linear() = turn * soles[leg].linear();
    motions[leg].X_WF.translation() = place + offset;
    motions[leg].w_WF = spin + turn * foot_rate;
    motions[leg].v_WF =
        planar_velocity + Vector3d(0.0, shift.sole_y_rate, 0.0) + spin.cross(offset);
  }
  return motions;
}

/// Moment of equal wrenches on both soles about the CoM.
Vector3d moment_about_com(const std::array<Eigen::Isometry3d, core::kLegs>& soles,
                          const Vector3d& com, const core::ContactWrenches& wrenches) {
  Vector3d moment = Vector3d::Zero();
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    moment += wrenches[leg].moment + (soles[leg].translation() - com).cross(wrenches[leg].force);
  }
  return moment;
}

/// Rolls the robot by a pair of vertical forces, and lets each foot push along the ground by how
/// much it bears: so both are equally far from slipping.
void share_load(const std::array<Eigen::Isometry3d, core::kLegs>& soles, const Matrix3d& turn,
                double roll_moment, core::ContactWrenches& wrenches) {
  const double spacing = (soles[0].translation() - soles[1].translation()).dot(turn.col(1));
  wrenches[0].force.z() += roll_moment / spacing;
  wrenches[1].force.z() -= roll_moment / spacing;
  const Vector3d total = wrenches[0].force + wrenches[1].force;
  for (core::Wrench& wrench : wrenches) {
    const double share = std::clamp(wrench.force.z() / total.z(), 0.0, 1.0);
    wrench.force.head<2>() = share * total.head<2>();
  }
}

/// Gives both feet this moment more: about the vertical by their own moments and, beyond those, by
/// a pair of forces along the soles; about the soles' cross axis by their own moments.
void add_moment(const std::array<Eigen::Isometry3d, core::kLegs>& soles, const Matrix3d& turn,
                const Vector3d& moment, core::ContactWrenches& wrenches) {
  const double spacing = (soles[0].translation() - soles[1].translation()).dot(turn.col(1));
  const double load = std::max(0.0, std::min(wrenches[0].force.z(), wrenches[1].force.z()));
  const double own = std::clamp(0.5 * moment.z(), -kFootYawArm * load, kFootYawArm * load);
  const Vector3d couple = turn.col(0) * ((moment.z() - 2.0 * own) / spacing);
  const Vector3d pitch = turn.col(1) * (0.5 * moment.dot(turn.col(1)));
  wrenches[0].force -= couple;
  wrenches[1].force += couple;
  for (core::Wrench& wrench : wrenches) wrench.moment += pitch + own * turn.col(2);
}

}  // namespace

SideLift::SideLift(const PlanarModel& model, const PlanarMotion& motion, const SideStep& step)
    : model_(model), motion_(motion), step_(step) {}

bool SideLift::place(const PlanarInstant& now, const SideShift& shift, core::JumpKnot& knot) const {
  const core::JumpKnot straight = straight_knot(model_, now);
  const std::array<SoleMotion, core::kLegs> soles =
      sole_motions(model_, step_, now, shift, straight);
  const Matrix3d turn = about_z(shift.yaw);
  const Vector3d spin(0.0, 0.0, shift.yaw_rate);
  const Vector3d arm = turn * (straight.p_WB - straight.p_WG);
  knot = straight;
  knot.p_WG = step_.point({straight.p_WG.x(), straight.p_WG.z()}, now.phase);
  knot.p_WG.head<2>() += shift.shift;
  knot.v_WG = about_z(shift.plane_yaw) * straight.v_WG;
  knot.v_WG.head<2>() += shift.velocity;
  knot.rpy.z() = shift.yaw;
  knot.w_WB = spin + turn * straight.w_WB;
  knot.p_WB = knot.p_WG + arm;
  knot.v_WB = knot.v_WG + turn * (straight.v_WB - straight.v_WG) + spin.cross(arm);
  for (int pass = 0; pass < kCentringPasses; ++pass) {
    if (!place_legs(model_.robot, soles, knot)) return false;
    const model::CompositeBody body = model::composite_body(model_.robot, model::state_of(knot));
    knot.p_WB += knot.p_WG - body.p_WG;
    knot.v_WB += knot.v_WG - body.v_WG;
  }
  return place_legs(model_.robot, soles, knot);
}

std::vector<double> SideLift::flight_momentum() const {
  std::vector<double> momentum;
  const auto measure = [&](const PlanarKnot& knot, double elapsed) {
    core::JumpKnot lifted;
    const SideShift shift = step_.at(knot.time + elapsed, core::JumpPhase::flight);
    if (!place(instant(model_, motion_, knot, elapsed), shift, lifted)) return false;
    momentum.push_back(model::composite_body(model_.robot, model::state_of(lifted)).momentum_W.z());
    return true;
  };
  const auto first = static_cast<std::size_t>(model_.config.steps.takeoff);
  const std::size_t end = first + static_cast<std::size_t>(model_.config.steps.flight);
  for (std::size_t i = first; i < end; ++i) {
    const PlanarKnot& knot = motion_.knots[i];
    if (!measure(knot, 0.0) || !measure(knot, 0.5 * knot.dt)) return {};
  }
  if (!measure(motion_.knots[end - 1], motion_.knots[end - 1].dt)) return {};
  return momentum;
}

bool SideLift::lift(const PlanarKnot& from, core::JumpKnot& knot) const {
  const PlanarInstant begin = instant(model_, motion_, from, 0.0);
  if (!place(begin, step_.at(from.time, from.phase), knot)) return false;
  const PlanarInstant now = instant(model_, motion_, from, 0.5 * from.dt);
  const SideShift shift = step_.at(from.time + 0.5 * from.dt, from.phase);
  core::JumpKnot middle;
  if (!place(now, shift, middle)) return false;
  set_efforts(now, shift, middle, knot);
  return true;
}

/// Newton and Euler: the feet give what the planar motion asks for, turned with its plane, and what
/// accelerates the CoM to the side and the trunk about the vertical, without a moment about roll.
void SideLift::set_efforts(const PlanarInstant& now, const SideShift& shift,
                           const core::JumpKnot& middle, core::JumpKnot& knot) const {
  knot.tau = straight_torques(now);
  if (now.phase == core::JumpPhase::flight) return;
  const core::JumpKnot straight = straight_knot(model_, now);
  const core::Wrench planar = straight_wrench(model_, now);
  const auto straight_soles = model::sole_poses(model_.robot, model::state_of(straight));
  const Vector3d planar_moment = moment_about_com(straight_soles, straight.p_WG, {planar, planar});
  const model::CompositeBody body = model::composite_body(model_.robot, model::state_of(middle));
  const auto soles = model::sole_poses(model_.robot, model::state_of(middle));
  const Matrix3d turn = about_z(shift.plane_yaw);
  const core::Wrench turned{turn * planar.force, turn * planar.moment};
  knot.wrenches.fill(turned);
  for (core::Wrench& wrench : knot.wrenches) {
    wrench.force.head<2>() += 0.5 * body.mass * shift.acceleration;
  }
  const Vector3d wanted = about_z(shift.yaw) * planar_moment +
                          Vector3d(0.0, 0.0, body.inertia_W(2, 2) * shift.yaw_acceleration);
  const auto missing = [&] {
    return Vector3d(wanted - moment_about_com(soles, body.p_WG, knot.wrenches));
  };
  share_load(soles, turn, missing().dot(turn.col(0)), knot.wrenches);
  add_moment(soles, turn, missing(), knot.wrenches);
  const Matrix3d R_BW = model::rotation_from_rpy(middle.rpy).transpose();
  for (const core::Leg leg : core::kAllLegs) {
    const core::Wrench& wrench = knot.wrenches[core::index(leg)];
    Eigen::Vector<double, 6> more;
    more << R_BW * (wrench.force - turned.force), R_BW * (wrench.moment - turned.moment);
    const int first = core::leg_offset(leg);
    const core::LegVector q = middle.q.segment<core::kJointsPerLeg>(first);
    knot.tau.segment<core::kJointsPerLeg>(first) -=
        model::sole_jacobian(model_.robot, leg, q).transpose() * more;
  }
}

}  // namespace hopscotch::planner
