#include "control/wrench_mpc_problem.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"

namespace hopscotch::control {

namespace {

constexpr double kGravity = 9.80665;  ///< [m/s^2]
constexpr double kPitchMax = 1.4;     ///< Roll-pitch-yaw is singular at pi / 2 [rad].

Eigen::Matrix3d yaw_rotation(double yaw) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// The angle but for full turns, nearest to zero [rad].
double wrapped(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

/// Attitude in H, with the turn of yaw that is nearest to `near_yaw`.
Eigen::Vector3d rpy_in(const Heading& heading, const Eigen::Vector3d& rpy, double near_yaw) {
  return {rpy.x(), rpy.y(), near_yaw + wrapped(rpy.z() - heading.yaw - near_yaw)};
}

BodyState reference_state(const Heading& heading, const core::ReferenceKnot& knot,
                          double near_yaw) {
  BodyState x;
  x << heading.R_HW * (knot.p_WG - heading.p_WH), rpy_in(heading, knot.rpy, near_yaw),
      heading.R_HW * knot.v_WG, heading.R_HW * knot.w_WB;
  return x;
}

BodyState measured_state(const Heading& heading, const model::CompositeBody& body,
                         const core::RobotState& state) {
  BodyState x;
  x << heading.R_HW * (body.p_WG - heading.p_WH),
      rpy_in(heading, model::rpy_from_rotation(state.R_WB), 0.0), heading.R_HW * body.v_WG,
      heading.R_HW * state.w_WB;
  return x;
}

/// What the velocities gain from the feet's reference wrenches in one step.
Eigen::Vector<double, 6> reference_gain(const WrenchQpStage& stage, double mass) {
  Eigen::Vector<double, 6> gain = Eigen::Vector<double, 6>::Zero();
  for (const WrenchQpFoot& foot : stage.feet) {
    if (!foot.contact) continue;
    const FootInput& u = foot.reference;
    const Eigen::Vector3d force =
        foot.R_force * Eigen::Vector3d(u(kForceX), u(kForceY), u(kForceZ));
    const Eigen::Vector3d moment = foot.R_moment * Eigen::Vector3d(0.0, u(kMomentY), u(kMomentZ));
    gain.head<3>() += stage.dt / mass * force;
    gain.tail<3>() += stage.dt * (stage.inertia_inverse * (foot.p_GF.cross(force) + moment));
  }
  return gain;
}

/// Contact, place and frame of a step's feet. The first step takes the feet where they are.
void pose_feet(const Heading& heading, const core::ReferenceKnot& knot,
               const std::array<Eigen::Vector3d, core::kLegs>& p_GF_W, WrenchQpStage& stage) {
  const Eigen::Matrix3d R_HF = yaw_rotation(knot.rpy.z() - heading.yaw);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    WrenchQpFoot& foot = stage.feet[leg];
    foot.contact = knot.contact[leg];
    if (!foot.contact) continue;
    foot.p_GF = heading.R_HW * p_GF_W[leg];
    foot.R_force = R_HF;
    foot.R_moment = R_HF;
    foot.reference = foot_input(knot.wrenches[leg], knot.rpy.z());
  }
}

std::array<Eigen::Vector3d, core::kLegs> measured_feet(const model::RobotParameters& robot,
                                                       const core::RobotState& state,
                                                       const Eigen::Vector3d& p_WG) {
  const std::array<Eigen::Isometry3d, core::kLegs> X_WF = model::sole_poses(robot, state);
  return {X_WF[0].translation() - p_WG, X_WF[1].translation() - p_WG};
}

bool is_finite(const core::RobotState& state) {
  return state.p_WB.allFinite() && state.R_WB.allFinite() && state.v_WB.allFinite() &&
         state.w_WB.allFinite() && state.q.allFinite() && state.dq.allFinite();
}

bool knot_is_usable(const core::ReferenceKnot& knot) {
  return knot.p_WG.allFinite() && knot.rpy.allFinite() && knot.v_WG.allFinite() &&
         knot.w_WB.allFinite() && std::abs(knot.rpy.y()) <= kPitchMax;
}

/// A step needs a length and, for each foot on the ground, its place and planned wrench.
bool step_is_usable(const core::ReferenceKnot& knot) {
  if (!(std::isfinite(knot.dt) && knot.dt > 0.0)) return false;
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    if (knot.contact[leg] && !(knot.p_WF[leg].allFinite() && knot.wrenches[leg].force.allFinite() &&
                               knot.wrenches[leg].moment.allFinite())) {
      return false;
    }
  }
  return true;
}

}  // namespace

Heading heading_of(const core::ControlReference& reference) noexcept {
  const core::ReferenceKnot& knot = reference.knots.front();
  return {knot.p_WG, yaw_rotation(-knot.rpy.z()), knot.rpy.z()};
}

Eigen::Matrix3d rpy_rate(const Eigen::Vector3d& rpy) noexcept {
  const double sin_yaw = std::sin(rpy.z());
  const double cos_yaw = std::cos(rpy.z());
  const double cos_pitch = std::cos(rpy.y());
  const double tan_pitch = std::tan(rpy.y());
  Eigen::Matrix3d T;
  T << cos_yaw / cos_pitch, sin_yaw / cos_pitch, 0.0,  //
      -sin_yaw, cos_yaw, 0.0,                          //
      cos_yaw * tan_pitch, sin_yaw * tan_pitch, 1.0;
  return T;
}

core::Wrench foot_wrench(const FootInput& input, double yaw) noexcept {
  const Eigen::Matrix3d R_WF = yaw_rotation(yaw);
  return {R_WF * Eigen::Vector3d(input(kForceX), input(kForceY), input(kForceZ)),
          R_WF * Eigen::Vector3d(0.0, input(kMomentY), input(kMomentZ))};
}

FootInput foot_input(const core::Wrench& wrench, double yaw) noexcept {
  const Eigen::Vector3d force = yaw_rotation(-yaw) * wrench.force;
  const Eigen::Vector3d moment = yaw_rotation(-yaw) * wrench.moment;
  FootInput input;
  input << force.x(), force.y(), moment.y(), moment.z(), force.z();
  return input;
}

bool can_pose(const core::RobotState& state, const core::ControlReference& reference,
              int horizon_max) noexcept {
  const std::size_t h = reference.horizon;
  if (h < 1 || h > static_cast<std::size_t>(horizon_max) || !is_finite(state)) return false;
  for (std::size_t k = 0; k <= h; ++k) {
    const core::ReferenceKnot& knot = reference.knots[k];
    if (!knot_is_usable(knot) || (k < h && !step_is_usable(knot))) return false;
  }
  return std::abs(model::rpy_from_rotation(state.R_WB).y()) <= kPitchMax;
}

WrenchQp constant_part(const WrenchMpcConfig& config, const model::RobotParameters& robot) {
  WrenchQp qp;
  qp.mass = robot.total_mass();
  qp.rule = config.rule;
  qp.state_weight = config.state_weight;
  qp.input_weight = config.wrench_weight;
  // The moment is about the sole centre, which lies ahead of the ankle. Centre of pressure there:
  // x = -My / Fz, so a centre of pressure towards the toe needs a negative moment.
  const double ahead = config.cop_toe - robot.sole_centre();
  const double behind = config.cop_heel + robot.sole_centre();
  qp.cone.upper << config.friction, config.friction, behind, config.yaw_moment_arm;
  qp.cone.lower << config.friction, config.friction, ahead, config.yaw_moment_arm;
  qp.cone.max_normal_force = config.max_normal_force;
  return qp;
}

void pose_problem(const model::RobotParameters& robot, const core::RobotState& state,
                  const core::ControlReference& reference, MpcForm form, WrenchQp& qp) noexcept {
  const Heading heading = heading_of(reference);
  const model::CompositeBody body = model::composite_body(robot, state);
  const Eigen::Matrix3d inertia_B_inverse =
      (state.R_WB.transpose() * body.inertia_W * state.R_WB).inverse();

  qp.horizon = static_cast<int>(reference.horizon);
  qp.x0 = measured_state(heading, body, state);
  const BodyState reference_x0 = reference_state(heading, reference.knots[0], 0.0);
  if (form == MpcForm::error_state) qp.x0 -= reference_x0;

  double yaw = 0.0;  // of knot k in H, without jumps by a turn
  for (std::size_t k = 0; k < reference.horizon; ++k) {
    const core::ReferenceKnot& knot = reference.knots[k];
    const bool first = k == 0;
    WrenchQpStage& stage = qp.stages[k];
    stage.dt = knot.dt;
    const Eigen::Vector3d rpy =
        rpy_in(heading, first ? model::rpy_from_rotation(state.R_WB) : knot.rpy, yaw);
    stage.rpy_rate = rpy_rate(rpy);
    const Eigen::Matrix3d R_HB = model::rotation_from_rpy(rpy);
    stage.inertia_inverse = R_HB * inertia_B_inverse * R_HB.transpose();
    pose_feet(heading, knot,
              first ? measured_feet(robot, state, body.p_WG)
                    : std::array<Eigen::Vector3d, core::kLegs>{knot.p_WF[0] - knot.p_WG,
                                                               knot.p_WF[1] - knot.p_WG},
              stage);

    const BodyState next = reference_state(heading, reference.knots[k + 1], yaw);
    yaw = next(5);
    if (form == MpcForm::error_state) {
      stage.target.setZero();
      stage.velocity_gain = -reference_gain(stage, qp.mass);
    } else {
      stage.target = next;
      stage.velocity_gain << 0.0, 0.0, -kGravity * knot.dt, 0.0, 0.0, 0.0;
      for (WrenchQpFoot& foot : stage.feet) foot.reference.setZero();
    }
  }
}

}  // namespace hopscotch::control
