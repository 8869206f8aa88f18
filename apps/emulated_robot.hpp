#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hardware/bus_model.hpp"
#include "hardware/bus_topology.hpp"
#include "hardware/drive_map.hpp"
#include "hardware/emulated_drive.hpp"
#include "hardware/imu.hpp"
#include "sim/mujoco_plant.hpp"

namespace hopscotch::apps {

struct EmulatedRobotOptions {
  sim::PlantOptions plant;  ///< Its latency must be zero: delays come from the wire.
  hardware::BusTopology topology;
  double watchdog = 0.0;         ///< Of the drives [s].
  double harness = 0.0;          ///< The robot hangs still for so long after all drives are on [s].
  double bus_error_share = 0.0;  ///< Frames destroyed by noise.
};

/// HECTOR in MuJoCo behind ten emulated drives on emulated buses, one millisecond at a time. In the
/// harness the world stands still; from its release on it goes on whatever the drives do.
/// Set-points that arrive during a tick act from the next one on; answers carry the shaft at the
/// tick's beginning.
class EmulatedRobot {
 public:
  explicit EmulatedRobot(const EmulatedRobotOptions& options);

  /// One millisecond of the world with what the buses' host sides have been given.
  void advance();

  /// For a real bus, which needs no model: the answer of the drives on `bus` to a frame, at once.
  [[nodiscard]] std::vector<hardware::CanFrame> answer(std::size_t bus,
                                                       const hardware::CanFrame& frame);

  [[nodiscard]] hardware::BusModel& bus(std::size_t index) { return buses_[index]; }
  [[nodiscard]] hardware::EmulatedDrive& drive(int joint) {
    return drives_[static_cast<std::size_t>(joint)];
  }
  [[nodiscard]] const hardware::BusTopology& topology() const { return topology_; }
  /// Of the last tick's beginning, in axes of B; nothing while the unit is switched off.
  [[nodiscard]] std::optional<hardware::ImuSample> imu() const;
  void switch_imu_off() { imu_on_ = false; }

  [[nodiscard]] core::Stamp now() const;
  [[nodiscard]] bool in_harness() const { return in_harness_; }
  /// For judging only.
  [[nodiscard]] sim::PlantTruth truth() const { return plant_.truth(); }
  [[nodiscard]] std::optional<core::Refusal> fault() const { return plant_.fault(); }

 private:
  [[nodiscard]] hardware::ShaftState shaft(std::size_t joint) const;
  [[nodiscard]] core::JointCommand drive_torques();
  void watch_harness();

  hardware::BusTopology topology_;
  double harness_;
  sim::MujocoPlant plant_;
  std::vector<hardware::BusModel> buses_;
  std::vector<hardware::EmulatedDrive> drives_;
  core::SensorReadings readings_;
  hardware::ShaftStates shafts_;
  core::SensorReadings imu_reading_;
  bool imu_on_ = true;
  bool in_harness_ = true;
  std::optional<core::Stamp> all_on_;
  std::int64_t tick_ = 0;
};

struct RobotConfig;

/// The emulated robot that the configuration asks for, in its home pose, soles level.
[[nodiscard]] EmulatedRobotOptions emulated_robot_options(const RobotConfig& config);

}  // namespace hopscotch::apps
