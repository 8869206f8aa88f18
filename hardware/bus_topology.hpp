#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/config_reader.hpp"
#include "core/robot_layout.hpp"
#include "hardware/drive_family.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::hardware {

/// One CAN bus.
struct BusSetup {
  std::string interface_name;
  double bit_rate = 0.0;       ///< [bit/s]
  double data_bit_rate = 0.0;  ///< Of the data phase of CAN FD; 0: classical CAN [bit/s].
};

/// How one joint's motor hangs on the wire. Shaft = output of the drive; motor angle = that of
/// `model::motor_speeds`, so at the ankle knee plus ankle.
struct DriveMount {
  std::size_t bus = 0;         ///< Index into the buses.
  std::uint8_t id = 0;         ///< Of commands.
  std::uint32_t reply_id = 0;  ///< Of answers.
  DriveFamily family;
  double sign = 1.0;    ///< +1 or -1: sense of the shaft against the motor angle.
  double gear = 1.0;    ///< Turns of the shaft per turn of the motor angle (the knee's belt).
  double offset = 0.0;  ///< Shaft angle at motor angle zero [rad].
};

/// The wiring of the robot, checked: sections `buses` and `drives` of the bus file.
struct BusTopology {
  double rate = 0.0;      ///< Exchanges per second [1/s].
  double load_max = 0.0;  ///< Largest share of a bus that may be used, all bits stuffed.
  std::vector<BusSetup> buses;
  std::array<DriveMount, core::kJoints> drives;

  /// @param drive_folder Where the families are, one file each.
  /// @throws core::ConfigError for impossible loads, identifiers that collide (equal modulo 128 on
  /// a bus, as the drives compare only seven bits) and every other broken rule.
  static BusTopology load(const core::ConfigReader& root,
                          const std::filesystem::path& drive_folder);
};

/// Share of its time that a bus is busy with commands and answers.
struct BusLoad {
  double least = 0.0;  ///< No bit stuffed.
  double most = 0.0;   ///< As many bits stuffed as can be.
};
[[nodiscard]] BusLoad bus_load(const BusTopology& topology, std::size_t bus);

/// Time on the wire of one frame with an 11-bit identifier, with the pause after it [s].
struct FrameTime {
  double least = 0.0;
  double most = 0.0;
};
[[nodiscard]] FrameTime frame_time(const BusSetup& bus, std::size_t bytes);

/// Joints whose drive, by its ranges, cannot be told the robot's full motor torque or speed; empty
/// when all can. Such a range would cut every command silently.
[[nodiscard]] std::string range_problem(const BusTopology& topology,
                                        const model::RobotParameters& robot);

/// e.g. "left_knee".
[[nodiscard]] std::string joint_name(int joint);

}  // namespace hopscotch::hardware
