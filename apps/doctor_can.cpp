#include "apps/doctor_can.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "apps/installation.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

// The drives sample at 13/15 of a bit; the kernel's own choice at 1 Mbit/s is 0.75. Farther apart
// than this the two see different bits on a long harness.
constexpr double kSamplePoint = 0.867;
constexpr double kSampleTolerance = 0.02;
// What waits longer than one exchange is stale: no bus has more than ten commands of one.
constexpr int kQueueMax = 16;

std::string number(double value, const char* format) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string set_up_command(const hardware::BusSetup& bus) {
  std::string command = "ip link set " + bus.interface_name + " down; ip link set " +
                        bus.interface_name + " txqueuelen " + std::to_string(kQueueMax) +
                        " up type can bitrate " + number(bus.bit_rate, "%.0f");
  if (bus.data_bit_rate > 0.0) {
    command += " sample-point 0.666 dbitrate " + number(bus.data_bit_rate, "%.0f") +
               " dsample-point 0.666 fd on";
  } else {
    command += " sample-point " + number(kSamplePoint, "%.3f");
  }
  return command + " restart-ms 0";
}

/// Adds a breach of what the robot needs.
struct Breaches {
  std::string text;
  void add(const std::string& what) { text += (text.empty() ? "" : ", ") + what; }
};

void check_controller(const hardware::BusSetup& bus, const hardware::CanInterface& interface,
                      Breaches& breaches) {
  if (interface.bit_rate && std::abs(*interface.bit_rate - bus.bit_rate) > 1.0) {
    breaches.add("bit rate " + number(*interface.bit_rate, "%.0f") + " instead of " +
                 number(bus.bit_rate, "%.0f"));
  }
  const bool sampled_elsewhere =
      interface.sample_point && bus.data_bit_rate <= 0.0 &&
      std::abs(*interface.sample_point - kSamplePoint) > kSampleTolerance;
  if (sampled_elsewhere) {
    breaches.add("sample point " + number(*interface.sample_point, "%.3f") + " instead of " +
                 number(kSamplePoint, "%.3f"));
  }
  if (interface.restart_ms.value_or(0) != 0) {
    breaches.add("restart-ms " + std::to_string(*interface.restart_ms) +
                 " hides a bus-off and sends stale commands after it");
  }
  const bool healthy = !interface.state || *interface.state == hardware::CanState::active;
  if (interface.up && !healthy) breaches.add("state " + can_state_name(*interface.state));
}

std::string description(const hardware::CanInterface& interface) {
  std::string text = interface.kind + (interface.up ? ", up" : ", down") + ", queue " +
                     std::to_string(interface.queue_length);
  if (interface.kind != "can") return text + ", no bit timing";
  text += ", " + number(interface.bit_rate.value_or(0.0), "%.0f") + " bit/s, sample point " +
          number(interface.sample_point.value_or(0.0), "%.3f") + ", restart-ms " +
          std::to_string(interface.restart_ms.value_or(0));
  if (interface.state) text += ", " + can_state_name(*interface.state);
  if (interface.send_errors) {
    text += ", error counters " + std::to_string(*interface.send_errors) + " sending " +
            std::to_string(interface.receive_errors.value_or(0)) + " receiving";
  }
  return text;
}

}  // namespace

Finding check_bus(const hardware::BusSetup& bus,
                  const std::optional<hardware::CanInterface>& interface) {
  Finding finding{.name = "CAN bus " + bus.interface_name, .needed_for = "the robot"};
  if (!interface) {
    finding.found = "no such interface";
    finding.fix = "plug in the adapter; " + set_up_command(bus) +
                  "; for emulation: ip link add dev " + bus.interface_name + " up type vcan";
    return finding;
  }
  finding.found = description(*interface);
  Breaches breaches;
  if (!interface->up) breaches.add("down");
  if (interface->kind == "can" && interface->queue_length > kQueueMax) {
    breaches.add("queue " + std::to_string(interface->queue_length) + " hides stale commands");
  }
  if (bus.data_bit_rate > 0.0 && !interface->flexible_data_rate) breaches.add("no CAN FD");
  check_controller(bus, *interface, breaches);
  finding.ok = breaches.text.empty();
  if (finding.ok) return finding;
  finding.found += ": " + breaches.text;
  const bool wires = interface->state == hardware::CanState::passive ||
                     interface->state == hardware::CanState::bus_off;
  finding.fix = (wires ? "switch the drives on, measure 60 ohm between CAN-H and CAN-L; " : "") +
                set_up_command(bus);
  return finding;
}

std::vector<Finding> check_can(const std::filesystem::path& wiring) {
  std::vector<Finding> findings;
  try {
    const std::vector<hardware::CanInterface> interfaces = hardware::can_interfaces();
    const hardware::BusTopology topology = hardware::BusTopology::load(
        core::ConfigReader::from_file(wiring), config_directory() / "drives");
    for (const hardware::BusSetup& bus : topology.buses) {
      const auto found = std::find_if(interfaces.begin(), interfaces.end(), [&](const auto& one) {
        return one.name == bus.interface_name;
      });
      const bool there = found != interfaces.end();
      findings.push_back(check_bus(bus, there ? std::optional(*found) : std::nullopt));
    }
  } catch (const std::exception& error) {
    findings.push_back({.name = "CAN buses",
                        .found = error.what(),
                        .fix = "correct what is named",
                        .needed_for = "the robot"});
  }
  return findings;
}

}  // namespace hopscotch::apps
