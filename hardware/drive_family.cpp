#include "hardware/drive_family.hpp"

namespace hopscotch::hardware {

using core::Range;

DriveFamily DriveFamily::load(const core::ConfigReader& root) {
  DriveFamily family;
  family.name = root.text("name");
  family.reply = static_cast<ReplyLayout>(
      root.choice("reply", {"mini-cheetah", "mini-cheetah-supply", "ak", "damiao"}));
  family.position_max = root.number("position_max_rad", Range::positive());
  family.speed_max = root.number("speed_max_radps", Range::positive());
  family.torque_max = root.number("torque_max_Nm", Range::positive());
  family.kp_max = root.number("kp_max_Nm_per_rad", Range::positive());
  family.kd_max = root.number("kd_max_Nms_per_rad", Range::positive());
  if (family.reply == ReplyLayout::mini_cheetah_supply) {
    family.supply_max = root.number("supply_max_V", Range::positive());
  }
  if (family.reply == ReplyLayout::ak) {
    family.temperature_offset_degC =
        root.number("temperature_offset_degC", Range::closed(-100.0, 100.0));
  }
  root.finish();
  return family;
}

DriveFamily DriveFamily::load(const std::filesystem::path& file) {
  return load(core::ConfigReader::from_file(file));
}

}  // namespace hopscotch::hardware
