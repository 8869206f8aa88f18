#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hopscotch::hardware {

enum class CanState : std::uint8_t { active, warning, passive, bus_off, stopped, sleeping };
[[nodiscard]] std::string can_state_name(CanState state);

/// What the kernel tells of one CAN interface. Virtual ones have no bit timing.
struct CanInterface {
  std::string name;
  std::string kind;  ///< "can", "vcan", ...
  bool up = false;
  int queue_length = 0;  ///< Frames that wait for the controller at most.
  bool flexible_data_rate = false;
  std::optional<CanState> state;
  std::optional<double> bit_rate;      ///< [bit/s]
  std::optional<double> sample_point;  ///< Share of a bit.
  std::optional<int> restart_ms;       ///< 0: a bus-off stays until somebody restarts it.
  std::optional<int> send_errors;      ///< Counter of the controller.
  std::optional<int> receive_errors;   ///< Counter of the controller.
};

/// All CAN interfaces of this machine by name, asked of the kernel by netlink. Empty where there is
/// none. @throws std::runtime_error if the kernel does not answer.
[[nodiscard]] std::vector<CanInterface> can_interfaces();

/// @return false too if there is no interface of this name.
[[nodiscard]] bool is_virtual(const std::vector<CanInterface>& interfaces, const std::string& name);

}  // namespace hopscotch::hardware
