#include "hardware/drive_family.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace hopscotch::hardware {
namespace {

const char* const kDamiao =
    "name: dm\nreply: damiao\nposition_max_rad: 12.5\nspeed_max_radps: 45\n"
    "torque_max_Nm: 54\nkp_max_Nm_per_rad: 500\nkd_max_Nms_per_rad: 5\n";

std::string complaint(const std::string& text) {
  try {
    DriveFamily::load(core::ConfigReader::from_text(text, "drive.yaml"));
  } catch (const core::ConfigError& error) {
    return error.what();
  }
  return {};
}

TEST(DriveFamily, EveryDriveOfTheConfigurationLoads) {
  const std::filesystem::path folder =
      std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config" / "drives";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const DriveFamily family = DriveFamily::load(entry.path());
    EXPECT_EQ(family.name, entry.path().stem().string());
    ++files;
  }
  EXPECT_GE(files, 10);
}

TEST(DriveFamily, ReadsEveryNumber) {
  const DriveFamily family = DriveFamily::load(core::ConfigReader::from_text(kDamiao, "dm.yaml"));
  EXPECT_EQ(family.reply, ReplyLayout::damiao);
  EXPECT_EQ(family.position_max, 12.5);
  EXPECT_EQ(family.speed_max, 45.0);
  EXPECT_EQ(family.torque_max, 54.0);
  EXPECT_EQ(family.kp_max, 500.0);
  EXPECT_EQ(family.kd_max, 5.0);
}

TEST(DriveFamily, EmptyRangeIsRefused) {
  EXPECT_EQ(complaint("name: dm\nreply: damiao\nposition_max_rad: 0\n"),
            "drive.yaml:3: position_max_rad = 0, but must satisfy 0 < x");
}

TEST(DriveFamily, UnknownLayoutIsRefused) {
  EXPECT_THAT(
      complaint("name: dm\nreply: servo\n"),
      ::testing::HasSubstr("drive.yaml:2: reply = servo, but must be one of mini-cheetah,"));
}

TEST(DriveFamily, KeyOfAnotherLayoutIsRefused) {
  EXPECT_EQ(complaint(std::string(kDamiao).append("supply_max_V: 40\n")),
            "drive.yaml:8: supply_max_V is not a known key here");
}

}  // namespace
}  // namespace hopscotch::hardware
