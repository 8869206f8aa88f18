#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/config_reader.hpp"

namespace hopscotch::hardware {

/// What a drive's answer holds besides position, speed and torque.
enum class ReplyLayout : std::uint8_t {
  mini_cheetah,         ///< 6 bytes, nothing more.
  mini_cheetah_supply,  ///< 7 bytes: supply voltage (firmware of 2023).
  ak,                   ///< 8 bytes: temperature, error code (CubeMars, T-Motor).
  damiao,               ///< 8 bytes: status in the first, temperatures of transistors and rotor.
};

/// How one model of drive with one firmware scales the numbers of its MIT-mode frames: a file of
/// `config/drives`. The ranges are settings of the drive; wrong ones are a silent error of the
/// gains, so read them back from the drive where it lets you, before enabling it.
struct DriveFamily {
  std::string name;
  ReplyLayout reply = ReplyLayout::mini_cheetah;
  double position_max = 0.0;  ///< Codes span +-this, at the output shaft [rad].
  double speed_max = 0.0;     ///< Codes span +-this [rad/s].
  double torque_max = 0.0;    ///< Codes span +-this [N·m].
  double kp_max = 0.0;        ///< Codes span 0 to this [N·m/rad].
  double kd_max = 0.0;        ///< Codes span 0 to this [N·m·s/rad].
  double supply_max = 0.0;    ///< Full code of the voltage, `mini_cheetah_supply` only [V].
  double temperature_offset_degC = 0;  ///< Added to the temperature byte, `ak` only.

  /// @throws core::ConfigError naming the key, its value and the violated rule.
  static DriveFamily load(const core::ConfigReader& root);
  static DriveFamily load(const std::filesystem::path& file);
};

}  // namespace hopscotch::hardware
