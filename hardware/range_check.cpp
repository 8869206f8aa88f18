#include "hardware/range_check.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace hopscotch::hardware {
namespace {

constexpr std::array<DriveRegister, 3> kRegisters{
    DriveRegister::position_max, DriveRegister::speed_max, DriveRegister::torque_max};
constexpr std::array<const char*, 3> kNames{"position", "speed", "torque"};

double expected(const DriveFamily& family, DriveRegister which) {
  switch (which) {
    case DriveRegister::position_max: return family.position_max;
    case DriveRegister::speed_max: return family.speed_max;
    case DriveRegister::torque_max: return family.torque_max;
  }
  return 0.0;
}

/// Asks until the answer is there; a lost frame is no mismatch.
std::optional<double> read_register(const BusTopology& topology, const PlantPorts& ports, int joint,
                                    DriveRegister which) {
  const DriveMount& drive = topology.drives[static_cast<std::size_t>(joint)];
  const CanPort& bus = ports.buses[drive.bus];
  const CanFrame request = encode_register_request(drive.id, which);
  constexpr int kAttempts = 5;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (bus.send({&request, 1}) != 1) return std::nullopt;
    ports.wait();
    std::optional<double> value;
    std::array<CanEvent, 32> events;
    for (std::size_t count = bus.receive(events); count > 0; count = bus.receive(events)) {
      for (std::size_t i = 0; i < count; ++i) {
        const CanEvent& event = events[i];
        if (event.kind != CanEvent::Kind::received || event.frame.id != drive.reply_id) continue;
        const std::optional<RegisterMessage> answer = decode_register(event.frame);
        if (answer && answer->drive_id == drive.id && answer->which == which) value = answer->value;
      }
    }
    if (value) return value;
  }
  return std::nullopt;
}

}  // namespace

RangeCheckResult check_ranges(const BusTopology& topology, const PlantPorts& ports) {
  RangeCheckResult result;
  const auto complain = [&](int joint, const std::string& what) {
    result.problem += (result.problem.empty() ? "" : "; ") + joint_name(joint) + " " + what;
  };
  for (int joint = 0; joint < core::kJoints; ++joint) {
    const DriveFamily& family = topology.drives[static_cast<std::size_t>(joint)].family;
    if (family.reply != ReplyLayout::damiao) {
      ++result.cannot_tell;
      continue;
    }
    bool agrees = true;
    for (std::size_t i = 0; i < kRegisters.size() && agrees; ++i) {
      const double wanted = expected(family, kRegisters[i]);
      const std::optional<double> value = read_register(topology, ports, joint, kRegisters[i]);
      constexpr double kTolerance = 1e-3;  // of a setting that is stored as a float [-]
      agrees = value && std::abs(*value - wanted) <= kTolerance * wanted;
      if (!value) {
        complain(joint, "does not answer");
      } else if (!agrees) {
        complain(joint, std::string("is set to a ") + kNames[i] + " range of " +
                            std::to_string(*value) + ", but " + family.name + ".yaml says " +
                            std::to_string(wanted));
      }
    }
    if (agrees) ++result.read;
  }
  return result;
}

}  // namespace hopscotch::hardware
