#include "hardware/bus_topology.hpp"

#include <algorithm>
#include <cmath>

#include "hardware/motor_protocol.hpp"

namespace hopscotch::hardware {
namespace {

using core::ConfigReader;
using core::Range;

constexpr int kIdentifierModulus = 128;  // drives compare the low seven bits only
constexpr std::size_t kCommandBytes = 8;

BusSetup load_bus(const ConfigReader& section) {
  BusSetup bus;
  bus.interface_name = section.text("interface");
  bus.bit_rate = section.number("bit_rate_bps", Range::closed(1.0e4, 1.0e6));
  bus.data_bit_rate =
      section.number_or("data_bit_rate_bps", 0.0, Range::closed(bus.bit_rate, 8.0e6));
  section.finish();
  return bus;
}

std::size_t bus_index(const ConfigReader& section, const std::vector<BusSetup>& buses) {
  std::vector<std::string> names;
  for (const BusSetup& bus : buses) names.push_back(bus.interface_name);
  return static_cast<std::size_t>(section.choice("bus", names));
}

DriveMount load_drive(const ConfigReader& section, const std::vector<BusSetup>& buses,
                      const std::filesystem::path& folder) {
  DriveMount drive;
  drive.bus = bus_index(section, buses);
  drive.id = static_cast<std::uint8_t>(section.integer("id", 1, kIdentifierModulus - 1));
  drive.reply_id =
      static_cast<std::uint32_t>(section.integer("reply_id", 0, kIdentifierModulus - 1));
  const std::string family = section.text("family");
  if (family.empty() || family.find('/') != std::string::npos) {
    section.reject("family", "must be the name of a file of config/drives");
  }
  drive.family = DriveFamily::load(folder / (family + ".yaml"));
  if (drive.family.reply == ReplyLayout::damiao && drive.id > 15) {
    section.reject("id", "must be below 16: this family answers with four bits of it");
  }
  drive.sign = section.integer("sign", -1, 1);
  if (drive.sign == 0.0) section.reject("sign", "must be 1 or -1");
  drive.gear = section.number("gear", Range::above(0.0, 100.0));
  drive.offset = section.number("offset_rad", Range::closed(-12.5, 12.5));
  section.finish();
  return drive;
}

/// Commands and answers of one bus must all differ in the bits that drives look at.
void check_identifiers(const ConfigReader& root, const BusTopology& topology) {
  for (std::size_t bus = 0; bus < topology.buses.size(); ++bus) {
    std::vector<std::uint32_t> used;
    for (const DriveMount& drive : topology.drives) {
      if (drive.bus != bus) continue;
      for (const std::uint32_t id : {static_cast<std::uint32_t>(drive.id), drive.reply_id}) {
        if (std::find(used.begin(), used.end(), id) != used.end()) {
          root.reject("drives", "identifier " + std::to_string(id) + " appears twice on " +
                                    topology.buses[bus].interface_name +
                                    ": commands and answers of a bus must all differ");
        }
        used.push_back(id);
      }
    }
  }
}

void check_loads(const ConfigReader& root, const BusTopology& topology) {
  for (std::size_t bus = 0; bus < topology.buses.size(); ++bus) {
    const BusLoad load = bus_load(topology, bus);
    if (load.most <= topology.load_max) continue;
    const auto percent = [](double share) { return std::to_string(std::lround(100.0 * share)); };
    root.reject("buses", topology.buses[bus].interface_name + " would be busy for " +
                             percent(load.least) + " to " + percent(load.most) +
                             " % of the time, but load_max is " + percent(topology.load_max) +
                             " %: fewer drives on it, a lower exchange_Hz, or CAN FD");
  }
}

}  // namespace

std::string joint_name(int joint) {
  const auto leg = static_cast<std::size_t>(joint / core::kJointsPerLeg);
  const auto at = static_cast<std::size_t>(joint % core::kJointsPerLeg);
  return std::string(core::kLegNames[leg]) + "_" + std::string(core::kJointNames[at]);
}

FrameTime frame_time(const BusSetup& bus, std::size_t bytes) {
  const auto payload = static_cast<double>(8 * bytes);
  if (bus.data_bit_rate <= 0.0) {
    // Start to CRC are 34 bits and the payload; with the rest and the pause of 3 it is 47. One bit
    // is stuffed after every four at worst.
    const double stuffed = std::floor((34.0 + payload - 1.0) / 4.0);
    return {(47.0 + payload) / bus.bit_rate, (47.0 + payload + stuffed) / bus.bit_rate};
  }
  // CAN FD: 17 bits before the switch of rate and 12 after it; between them 11 bits of control, a
  // CRC of 17 with its count, 6 fixed stuff bits and delimiter, and the payload.
  constexpr double kSlow = 29.0;
  constexpr double kFast = 33.0;
  constexpr double kSlowStuffed = 4.0;
  const double stuffed = std::floor((5.0 + payload) / 4.0);
  return {kSlow / bus.bit_rate + (kFast + payload) / bus.data_bit_rate,
          (kSlow + kSlowStuffed) / bus.bit_rate + (kFast + payload + stuffed) / bus.data_bit_rate};
}

BusLoad bus_load(const BusTopology& topology, std::size_t bus) {
  BusLoad load;
  for (const DriveMount& drive : topology.drives) {
    if (drive.bus != bus) continue;
    for (const std::size_t bytes : {kCommandBytes, reply_size(drive.family.reply)}) {
      const FrameTime time = frame_time(topology.buses[bus], bytes);
      load.least += topology.rate * time.least;
      load.most += topology.rate * time.most;
    }
  }
  return load;
}

std::string range_problem(const BusTopology& topology, const model::RobotParameters& robot) {
  std::string problem;
  for (int joint = 0; joint < core::kJoints; ++joint) {
    const DriveMount& drive = topology.drives[static_cast<std::size_t>(joint)];
    const model::MotorParameters& motor =
        robot.motors[static_cast<std::size_t>(joint % core::kJointsPerLeg)];
    const double torque = motor.torque_max / drive.gear;
    const double speed = motor.speed_max * drive.gear;
    if (torque <= drive.family.torque_max && speed <= drive.family.speed_max) continue;
    problem += (problem.empty() ? "" : "; ") + joint_name(joint) + " needs " +
               std::to_string(torque) + " Nm and " + std::to_string(speed) + " rad/s, but " +
               drive.family.name + " spans " + std::to_string(drive.family.torque_max) +
               " Nm and " + std::to_string(drive.family.speed_max) + " rad/s";
  }
  return problem;
}

BusTopology BusTopology::load(const ConfigReader& root, const std::filesystem::path& drive_folder) {
  BusTopology topology;
  topology.rate = root.number("exchange_Hz", Range::closed(50.0, 4000.0));
  topology.load_max = root.number("load_max", Range::above(0.0, 1.0));
  for (const ConfigReader& section : root.list("buses")) {
    topology.buses.push_back(load_bus(section));
  }
  const ConfigReader drives = root.section("drives");
  for (int joint = 0; joint < core::kJoints; ++joint) {
    topology.drives[static_cast<std::size_t>(joint)] =
        load_drive(drives.section(joint_name(joint)), topology.buses, drive_folder);
  }
  drives.finish();
  check_identifiers(root, topology);
  check_loads(root, topology);
  return topology;
}

}  // namespace hopscotch::hardware
