#include "sim/drive.hpp"

#include "model/motor.hpp"

namespace hopscotch::sim {

core::JointVector drive_demand(const core::JointCommand& command, const DriveReading& reading) {
  switch (command.mode) {
    case core::DriveMode::idle: return core::JointVector::Zero();
    case core::DriveMode::damp: return -command.kd.cwiseProduct(reading.dq);
    case core::DriveMode::active:
      return command.tau + command.kp.cwiseProduct(command.q - reading.q) +
             command.kd.cwiseProduct(command.dq - reading.dq);
  }
  return core::JointVector::Zero();
}

core::JointVector limited_by_motors(const model::RobotParameters& robot,
                                    const core::JointVector& demand,
                                    const core::JointVector& joint_speed, double strength) {
  core::JointVector applied;
  for (const core::Leg leg : core::kAllLegs) {
    const int first = core::leg_offset(leg);
    const core::LegVector leg_demand = demand.segment<core::kJointsPerLeg>(first);
    const core::LegVector leg_speed = joint_speed.segment<core::kJointsPerLeg>(first);
    applied.segment<core::kJointsPerLeg>(first) =
        model::saturate(robot, leg_demand, leg_speed, strength);
  }
  return applied;
}

}  // namespace hopscotch::sim
