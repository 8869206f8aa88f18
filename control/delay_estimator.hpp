#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/joint_command.hpp"
#include "core/sensor_readings.hpp"

namespace hopscotch::control {

/// How many exchanges pass between a command and its torque, found while the robot stands: each
/// candidate says what the drives would have been asked for, the measured torques say which is
/// true. Real-time: nothing allocates, locks or throws.
class DelayEstimator {
 public:
  static constexpr std::size_t kCandidates = 11;  ///< 0 to 10 exchanges.

  /// One exchange, in this order: what came in and what was sent upon it.
  void received(const core::SensorReadings& readings) noexcept;
  void sent(const core::JointCommand& command) noexcept;

  /// The delay [s] once the best candidate is clear; nothing before.
  [[nodiscard]] std::optional<double> delay() const noexcept;

 private:
  static constexpr std::size_t kMemory = kCandidates + 1;
  [[nodiscard]] const core::JointCommand& command_before(std::size_t exchanges) const noexcept;

  std::array<core::JointCommand, kMemory> commands_{};
  std::array<double, kCandidates> squares_{};
  core::SensorReadings last_;
  std::size_t sent_ = 0;
  std::size_t samples_ = 0;
  double period_ = 0.0;  ///< [s]
};

}  // namespace hopscotch::control
