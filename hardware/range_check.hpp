#pragma once

#include <string>

#include "hardware/robot_plant.hpp"

namespace hopscotch::hardware {

struct RangeCheckResult {
  std::string problem;  ///< Which drive is set to which range; empty when all that can tell agree.
  int read = 0;         ///< Drives whose ranges were read and agree.
  int cannot_tell = 0;  ///< Drives of families that have no way to tell.
};

/// Reads the ranges of every drive that lets one and compares them with its family's file, before
/// anything is enabled: a wrong torque range is a silent error of all gains. At start-up only.
[[nodiscard]] RangeCheckResult check_ranges(const BusTopology& topology, const PlantPorts& ports);

}  // namespace hopscotch::hardware
