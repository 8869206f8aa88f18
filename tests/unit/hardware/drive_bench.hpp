#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config_reader.hpp"
#include "hardware/bus_model.hpp"
#include "hardware/drive_map.hpp"
#include "hardware/emulated_drive.hpp"
#include "hardware/homing.hpp"
#include "hardware/robot_plant.hpp"
#include "hardware/soft_stop.hpp"

namespace hopscotch::hardware::testing {

inline const std::string kConfigFolder = std::string(HOPSCOTCH_SOURCE_DIR) + "/config/";

inline core::ConfigReader bus_file() {
  return core::ConfigReader::from_file(kConfigFolder + "robot_bus.yaml");
}
inline BusTopology shipped_topology() {
  return BusTopology::load(bus_file(), kConfigFolder + "drives");
}
inline RobotPlantConfig shipped_plant_config() {
  return RobotPlantConfig::load(bus_file().section("plant"));
}
inline model::RobotParameters hector() {
  return model::RobotParameters::load(kConfigFolder + "robots/hector.yaml");
}

/// Ten emulated drives on emulated buses, each shaft with an inertia of its own and nothing else:
/// enough to see what goes over the wire and comes back.
class DriveBench {
 public:
  explicit DriveBench(const BusTopology& topology, const BusModelOptions& options = {})
      : topology_(topology) {
    constexpr double kWatchdog = 0.025;  // [s]
    for (const BusSetup& setup : topology.buses) buses_.emplace_back(setup, options);
    for (const DriveMount& mount : topology.drives) drives_.emplace_back(mount, kWatchdog);
    JointStates home{.q = core::JointVector::Zero(),
                     .dq = core::JointVector::Zero(),
                     .tau = core::JointVector::Zero()};
    home.q = HomingConfig::load(bus_file().section("homing")).joints();
    shafts_ = shaft_states(topology, home);
  }

  /// One exchange period of simulated time.
  core::Stamp advance() {
    const double period = 1.0 / topology_.rate;
    for (std::size_t i = 0; i < core::kJoints; ++i) {
      shafts_.torque[i] = drives_[i].torque(shaft(i), now_);
    }
    for (std::size_t bus = 0; bus < buses_.size(); ++bus) {
      buses_[bus].advance(now_.after(period), [&](const CanFrame& frame, core::Stamp at) {
        std::vector<CanFrame> answers;
        for (std::size_t i = 0; i < core::kJoints; ++i) {
          if (topology_.drives[i].bus != bus) continue;
          if (const auto answer = drives_[i].receive(frame, shaft(i), at))
            answers.push_back(*answer);
        }
        return answers;
      });
    }
    constexpr double kInertia = 0.02;  // [kg·m^2]
    for (std::size_t i = 0; i < core::kJoints; ++i) {
      shafts_.speed[i] += period * shafts_.torque[i] / kInertia;
      shafts_.position[i] += period * shafts_.speed[i];
    }
    now_ = now_.after(period);
    return now_;
  }

  PlantPorts ports() {
    PlantPorts ports;
    for (BusModel& bus : buses_) ports.buses.push_back(bus.host_port());
    ports.wait = [this] {
      core::Stamp now = advance();
      for (; extra_periods_ > 0; --extra_periods_) now = advance();
      return now;
    };
    ports.imu = [this] {
      ImuSample still;
      still.force.z() = 9.81;
      return imu_lost ? std::nullopt : std::optional(still);
    };
    return ports;
  }

  BusModel& bus(std::size_t i) { return buses_[i]; }
  EmulatedDrive& drive(int joint) { return drives_[static_cast<std::size_t>(joint)]; }
  [[nodiscard]] JointStates joints() const { return joint_states(topology_, shafts_); }
  /// The host sleeps through so many periods at its next wait.
  void stall(int periods) { extra_periods_ = periods; }
  [[nodiscard]] core::Stamp now() const { return now_; }

  bool imu_lost = false;

 private:
  [[nodiscard]] ShaftState shaft(std::size_t i) const {
    return {shafts_.position[i], shafts_.speed[i], shafts_.torque[i]};
  }

  BusTopology topology_;
  std::vector<BusModel> buses_;
  std::vector<EmulatedDrive> drives_;
  ShaftStates shafts_;
  core::Stamp now_;
  int extra_periods_ = 0;
};

/// Holds `q` with the gains of the controller.
inline core::JointCommand hold(const core::JointVector& q) {
  core::JointCommand command;
  command.mode = core::DriveMode::active;
  command.q = q;
  command.kp.setConstant(60.0);
  command.kd.setConstant(2.0);
  return command;
}

}  // namespace hopscotch::hardware::testing
