#include "hardware/bus_topology.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/unit/hardware/drive_bench.hpp"

namespace hopscotch::hardware {
namespace {

std::string shipped_text() {
  std::ostringstream text;
  text << std::ifstream(testing::kConfigFolder + "robot_bus.yaml").rdbuf();
  return text.str();
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(BusTopology::load(core::ConfigReader::from_text(text, "bus.yaml"),
                                        testing::kConfigFolder + "drives"));
  } catch (const core::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(BusTopology, FrameTimesAreThoseOfTheStandard) {
  const BusSetup classical{.interface_name = "can0", .bit_rate = 1e6};
  EXPECT_NEAR(frame_time(classical, 8).least, 111e-6, 1e-12);
  EXPECT_NEAR(frame_time(classical, 8).most, 135e-6, 1e-12);
  EXPECT_NEAR(frame_time(classical, 6).least, 95e-6, 1e-12);
  EXPECT_NEAR(frame_time(classical, 6).most, 115e-6, 1e-12);
  const BusSetup flexible{.interface_name = "can0", .bit_rate = 1e6, .data_bit_rate = 5e6};
  EXPECT_NEAR(frame_time(flexible, 8).least, 49e-6, 1e-6);
  EXPECT_NEAR(frame_time(flexible, 8).most, 57e-6, 1.5e-6);
}

TEST(BusTopology, ShippedWiringFitsItsBuses) {
  const BusTopology topology = testing::shipped_topology();
  ASSERT_EQ(topology.buses.size(), 4U);
  EXPECT_NEAR(bus_load(topology, 0).least, 0.666, 1e-3);  // three drives
  EXPECT_NEAR(bus_load(topology, 0).most, 0.810, 1e-3);
  EXPECT_NEAR(bus_load(topology, 1).most, 0.540, 1e-3);  // knee and ankle
  EXPECT_EQ(range_problem(topology, testing::hector()), "");
}

TEST(BusTopology, AlternativesFitToo) {
  for (const char* name : {"robot_bus-500Hz.yaml", "robot_bus-fd.yaml"}) {
    const BusTopology topology =
        BusTopology::load(core::ConfigReader::from_file(testing::kConfigFolder + name),
                          testing::kConfigFolder + "drives");
    EXPECT_EQ(topology.buses.size(), 2U) << name;
    EXPECT_LT(bus_load(topology, 0).most, 0.7) << name;
  }
}

TEST(BusTopology, ImpossibleLoadIsRefusedWithNumbers) {
  const std::string error =
      error_of(replaced(shipped_text(), "exchange_Hz: 1000", "exchange_Hz: 2000"));
  EXPECT_NE(error.find("can0 would be busy for 133 to 162 %"), std::string::npos) << error;
}

TEST(BusTopology, IdentifiersThatCollideAreRefused) {
  const std::string error =
      error_of(replaced(shipped_text(), "id: 2, reply_id: 34", "id: 2, reply_id: 33"));
  EXPECT_NE(error.find("identifier 33 appears twice on can0"), std::string::npos) << error;
}

TEST(BusTopology, UnknownBusAndFamilyAreRefused) {
  EXPECT_NE(error_of(replaced(shipped_text(), "{bus: can0, id: 1,", "{bus: can9, id: 1,")), "");
  EXPECT_NE(error_of(replaced(shipped_text(), "family: dm8009", "family: nobody")), "");
}

TEST(BusTopology, DriveTooWeakForItsJointIsNamed) {
  BusTopology topology = testing::shipped_topology();
  topology.drives[3].gear = 1.0;  // without its belt the knee's drive cannot give 67 Nm
  const std::string problem = range_problem(topology, testing::hector());
  EXPECT_NE(problem.find("left_knee needs 67"), std::string::npos) << problem;
}

}  // namespace
}  // namespace hopscotch::hardware
