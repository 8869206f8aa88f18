#pragma once

#include "core/joint_command.hpp"
#include "core/sensor_readings.hpp"

namespace hopscotch::core {

/// The robot as the controller sees it: simulated or real.
class Plant {
 public:
  virtual ~Plant() = default;
  /// Sends the set-points and returns the readings of the tick that has just passed.
  virtual SensorReadings exchange(const JointCommand& command) = 0;
};

}  // namespace hopscotch::core
