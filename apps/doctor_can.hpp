#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "apps/finding.hpp"
#include "hardware/bus_topology.hpp"
#include "hardware/can_interface.hpp"

namespace hopscotch::apps {

/// Whether the kernel has CAN, and each bus of the robot's wiring with its interface as it is: bit
/// rate, sample point, restart, queue, state and error counters, with the command that puts it
/// right.
/// @param wiring The robot's bus file.
[[nodiscard]] std::vector<Finding> check_can(const std::filesystem::path& wiring);

/// The same for one bus. @param interface Nothing: this machine has none of that name.
[[nodiscard]] Finding check_bus(const hardware::BusSetup& bus,
                                const std::optional<hardware::CanInterface>& interface);

}  // namespace hopscotch::apps
