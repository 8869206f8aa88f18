#include "hardware/drive_map.hpp"

#include "model/motor.hpp"

namespace hopscotch::hardware {
namespace {

using core::JointVector;
using core::LegVector;

constexpr Eigen::Index kKnee = static_cast<Eigen::Index>(core::Joint::knee);
constexpr Eigen::Index kAnkle = static_cast<Eigen::Index>(core::Joint::ankle);

/// A function of one leg applied to both.
template <typename Function>
JointVector by_leg(const JointVector& all, Function function) {
  JointVector result;
  for (const core::Leg leg : core::kAllLegs) {
    const int first = core::leg_offset(leg);
    const LegVector part = all.segment<core::kJointsPerLeg>(first);
    result.segment<core::kJointsPerLeg>(first) = function(part);
  }
  return result;
}

/// From motor angles, or their rates, to joint angles: the inverse of `model::motor_speeds`.
LegVector joints_of_motors(const LegVector& motors) {
  LegVector joints = motors;
  joints(kAnkle) -= motors(kKnee);
  return joints;
}

/// The knee's motor closes both its own stiffness and, as the ankle's motor reacts on the thigh,
/// the ankle's.
LegVector motor_gains(const LegVector& joint_gains) {
  LegVector gains = joint_gains;
  gains(kKnee) += joint_gains(kAnkle);
  return gains;
}

/// Motor-side set-points, referred to the joint side of each reduction.
struct MotorSetpoints {
  JointVector position, speed, kp, kd, tau;
};

MotorSetpoints motor_setpoints(const core::JointCommand& command, const JointVector& q,
                               const JointVector& dq) {
  MotorSetpoints motor;
  motor.position = by_leg(command.q, model::motor_speeds);
  motor.speed = by_leg(command.dq, model::motor_speeds);
  motor.kp = by_leg(command.kp, motor_gains);
  motor.kd = by_leg(command.kd, motor_gains);
  motor.tau = by_leg(command.tau, model::motor_torques);
  for (const core::Leg leg : core::kAllLegs) {
    const int knee = core::joint_index(leg, core::Joint::knee);
    const int ankle = core::joint_index(leg, core::Joint::ankle);
    const double knee_error = command.q(knee) - q(knee);
    const double knee_speed_error = command.dq(knee) - dq(knee);
    const double ankle_error = command.q(ankle) - q(ankle) + knee_error;  // of the ankle's motor
    const double ankle_speed_error = command.dq(ankle) - dq(ankle) + knee_speed_error;
    const double kp = command.kp(ankle);
    const double kd = command.kd(ankle);
    motor.tau(knee) -= kp * ankle_error + kd * ankle_speed_error;
    motor.tau(ankle) -= kp * knee_error + kd * knee_speed_error;
  }
  return motor;
}

MotorSetpoints damping_setpoints(const core::JointCommand& command, const JointVector& q) {
  MotorSetpoints motor;
  motor.position = by_leg(q, model::motor_speeds);
  motor.speed.setZero();
  motor.kp.setZero();
  motor.kd = command.kd;
  motor.tau.setZero();
  return motor;
}

}  // namespace

JointStates joint_states(const BusTopology& topology, const ShaftStates& shafts) {
  JointStates motors;
  for (std::size_t i = 0; i < core::kJoints; ++i) {
    const DriveMount& drive = topology.drives[i];
    const double turns = drive.sign * drive.gear;
    const auto joint = static_cast<Eigen::Index>(i);
    motors.q(joint) = (shafts.position[i] - drive.offset) / turns;
    motors.dq(joint) = shafts.speed[i] / turns;
    motors.tau(joint) = shafts.torque[i] * turns;
  }
  return {.q = by_leg(motors.q, joints_of_motors),
          .dq = by_leg(motors.dq, joints_of_motors),
          .tau = by_leg(motors.tau, model::joint_torques)};
}

ShaftStates shaft_states(const BusTopology& topology, const JointStates& joints) {
  const JointVector position = by_leg(joints.q, model::motor_speeds);
  const JointVector speed = by_leg(joints.dq, model::motor_speeds);
  const JointVector torque = by_leg(joints.tau, model::motor_torques);
  ShaftStates shafts;
  for (std::size_t i = 0; i < core::kJoints; ++i) {
    const DriveMount& drive = topology.drives[i];
    const double turns = drive.sign * drive.gear;
    const auto joint = static_cast<Eigen::Index>(i);
    shafts.position[i] = turns * position(joint) + drive.offset;
    shafts.speed[i] = turns * speed(joint);
    shafts.torque[i] = torque(joint) / turns;
  }
  return shafts;
}

std::array<DriveSetpoint, core::kJoints> drive_setpoints(const BusTopology& topology,
                                                         const core::JointCommand& command,
                                                         const JointVector& q,
                                                         const JointVector& dq) {
  const MotorSetpoints motor = command.mode == core::DriveMode::active
                                   ? motor_setpoints(command, q, dq)
                                   : damping_setpoints(command, q);
  std::array<DriveSetpoint, core::kJoints> setpoints;
  for (std::size_t i = 0; i < core::kJoints; ++i) {
    const DriveMount& drive = topology.drives[i];
    const double turns = drive.sign * drive.gear;
    const auto joint = static_cast<Eigen::Index>(i);
    setpoints[i] = {.position = turns * motor.position(joint) + drive.offset,
                    .speed = turns * motor.speed(joint),
                    .kp = motor.kp(joint) / (drive.gear * drive.gear),
                    .kd = motor.kd(joint) / (drive.gear * drive.gear),
                    .torque = motor.tau(joint) / turns};
  }
  return setpoints;
}

}  // namespace hopscotch::hardware
