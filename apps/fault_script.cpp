#include "apps/fault_script.hpp"

#include <algorithm>
#include <string>

#include "apps/emulated_robot.hpp"
#include "hardware/bus_topology.hpp"

namespace hopscotch::apps {

namespace {

std::vector<std::string> joint_names() {
  std::vector<std::string> names;
  names.reserve(core::kJoints);
  for (int joint = 0; joint < core::kJoints; ++joint) names.push_back(hardware::joint_name(joint));
  return names;
}

void happen(const ScriptedFault& fault, EmulatedRobot& robot) {
  hardware::DriveDefects& defects = robot.drive(fault.joint).defects();
  hardware::BusModel& bus = robot.bus(static_cast<std::size_t>(fault.bus));
  const auto& drives = robot.topology().drives;
  const auto at = static_cast<std::size_t>(fault.joint);
  const std::size_t next = (at + 1) % drives.size();
  switch (fault.kind) {
    case ScriptedFault::Kind::lost_replies: bus.lose_answers(fault.count); break;
    case ScriptedFault::Kind::silent: defects.silent = true; break;
    case ScriptedFault::Kind::over_temperature:
      defects.fault = hardware::DriveFault::over_temperature;
      break;
    case ScriptedFault::Kind::swapped_replies:
      defects.reply_id = drives[next].reply_id;
      robot.drive(static_cast<int>(next)).defects().reply_id = drives[at].reply_id;
      break;
    case ScriptedFault::Kind::wrong_range:
      defects.torque_max = drives[at].family.torque_max / 3.0;
      break;
    case ScriptedFault::Kind::bus_off: bus.force_bus_off(); break;
    case ScriptedFault::Kind::cut_bus: bus.cut(); break;
    case ScriptedFault::Kind::full_queue: bus.fill_queue(); break;
    case ScriptedFault::Kind::stuck_encoder: defects.encoder_stuck = true; break;
    case ScriptedFault::Kind::imu_loss: robot.switch_imu_off(); break;
  }
}

}  // namespace

ScriptedFault ScriptedFault::load(const core::ConfigReader& section) {
  ScriptedFault fault;
  fault.kind = static_cast<Kind>(section.choice(
      "kind", {"lost_replies", "silent", "over_temperature", "swapped_replies", "wrong_range",
               "bus_off", "cut_bus", "full_queue", "stuck_encoder", "imu_loss"}));
  fault.moment =
      static_cast<Moment>(section.choice("moment", {"at_time", "in_stance", "in_flight"}));
  fault.after = section.number("after_s", core::Range::not_negative());
  if (section.has("joint")) fault.joint = section.choice("joint", joint_names());
  fault.bus = section.integer_or("bus", 0, 0, 9);
  fault.count = section.integer_or("count", 1, 1, 100000);
  section.finish();
  return fault;
}

bool FaultScript::due(const ScriptedFault& fault, const EmulatedRobot& robot) const {
  const core::Stamp now = robot.now();
  switch (fault.moment) {
    case ScriptedFault::Moment::at_time: return now.seconds() >= fault.after;
    case ScriptedFault::Moment::in_stance: return released_ && now.since(*released_) >= fault.after;
    case ScriptedFault::Moment::in_flight: return lifted_ && now.since(*lifted_) >= fault.after;
  }
  return false;
}

void FaultScript::play(EmulatedRobot& robot) {
  if (faults_.empty()) return;
  if (!robot.in_harness()) {
    if (!released_) released_ = robot.now();
    const auto contact = robot.truth().state.contact;
    const bool airborne = !contact[0] && !contact[1];
    if (!airborne) lifted_.reset();
    // The feet also leave the ground for moments when they are put down.
    constexpr double kPutDown = 0.1;  // [s]
    if (airborne && !lifted_ && robot.now().since(*released_) > kPutDown) lifted_ = robot.now();
  }
  const auto begin = std::stable_partition(faults_.begin(), faults_.end(),
                                           [&](const auto& fault) { return !due(fault, robot); });
  std::for_each(begin, faults_.end(), [&](const auto& fault) { happen(fault, robot); });
  faults_.erase(begin, faults_.end());
}

}  // namespace hopscotch::apps
