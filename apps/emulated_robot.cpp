#include "apps/emulated_robot.hpp"

#include <algorithm>

#include "apps/robot_config.hpp"
#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "sim/disturbance.hpp"

namespace hopscotch::apps {

using hardware::CanFrame;

namespace {

/// What the sensors say before anything has moved.
core::SensorReadings readings_at_rest(const sim::PlantTruth& truth) {
  core::SensorReadings readings;
  readings.stamp = truth.state.stamp;
  readings.q = truth.state.q;
  readings.dq.setZero();
  readings.tau.setZero();
  readings.w_WB_B.setZero();
  readings.f_B = truth.state.R_WB.transpose() * Eigen::Vector3d(0.0, 0.0, model::kGravity);
  return readings;
}

hardware::ShaftStates shafts_of(const hardware::BusTopology& topology,
                                const core::SensorReadings& readings) {
  return hardware::shaft_states(topology,
                                {.q = readings.q, .dq = readings.dq, .tau = readings.tau});
}

}  // namespace

EmulatedRobotOptions emulated_robot_options(const RobotConfig& config) {
  const core::JointVector home = config.homing.joints();
  const double pitch = -(home[core::joint_index(core::Leg::left, core::Joint::hip_pitch)] +
                         home[core::joint_index(core::Leg::left, core::Joint::knee)] +
                         home[core::joint_index(core::Leg::left, core::Joint::ankle)]);
  return {.plant = {.scenario = config.emulation.scenario,
                    .robot = config.robot,
                    .posture = {.q = home, .trunk_pitch = pitch},
                    .variation = {},
                    .seed = config.emulation.seed},
          .topology = config.topology,
          .watchdog = config.emulation.watchdog,
          .harness = config.emulation.harness,
          .bus_error_share = config.emulation.bus_error_share};
}

EmulatedRobot::EmulatedRobot(const EmulatedRobotOptions& options)
    : topology_(options.topology),
      harness_(options.harness),
      plant_(options.plant),
      readings_(readings_at_rest(plant_.truth())),
      shafts_(shafts_of(topology_, readings_)),
      imu_reading_(readings_) {
  for (std::size_t i = 0; i < topology_.buses.size(); ++i) {
    buses_.emplace_back(
        topology_.buses[i],
        hardware::BusModelOptions{.error_share = options.bus_error_share,
                                  .seed = options.plant.seed * topology_.buses.size() + i});
  }
  for (const hardware::DriveMount& mount : topology_.drives) {
    drives_.emplace_back(mount, options.watchdog);
  }
}

core::Stamp EmulatedRobot::now() const {
  return {tick_ * core::Stamp::from_seconds(sim::kTick).nanoseconds};
}

hardware::ShaftState EmulatedRobot::shaft(std::size_t joint) const {
  return {shafts_.position[joint], shafts_.speed[joint], shafts_.torque[joint]};
}

std::vector<CanFrame> EmulatedRobot::answer(std::size_t bus, const CanFrame& frame) {
  std::vector<CanFrame> answers;
  for (std::size_t joint = 0; joint < core::kJoints; ++joint) {
    if (topology_.drives[joint].bus != bus) continue;
    if (const auto answer = drives_[joint].receive(frame, shaft(joint), now())) {
      answers.push_back(*answer);
    }
  }
  return answers;
}

/// Torques of the set-points that have arrived by the beginning of this tick.
core::JointCommand EmulatedRobot::drive_torques() {
  hardware::ShaftStates torques = shafts_;
  for (std::size_t joint = 0; joint < core::kJoints; ++joint) {
    torques.torque[joint] = drives_[joint].torque(shaft(joint), now());
  }
  core::JointCommand command;
  command.mode = core::DriveMode::active;
  command.tau = hardware::joint_states(topology_, torques).tau;
  return command;
}

void EmulatedRobot::watch_harness() {
  const bool all_on = std::all_of(drives_.begin(), drives_.end(),
                                  [](const auto& drive) { return drive.in_motor_mode(); });
  if (!all_on) all_on_.reset();
  if (all_on && !all_on_) all_on_ = now();
  if (all_on_ && now().since(*all_on_) >= harness_) in_harness_ = false;
}

void EmulatedRobot::advance() {
  const core::JointCommand command = drive_torques();
  const core::Stamp end = now().after(sim::kTick);
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    buses_[i].advance(end, [&](const CanFrame& frame, core::Stamp) { return answer(i, frame); });
  }
  imu_reading_ = readings_;
  imu_reading_.stamp = now();
  watch_harness();
  if (!in_harness_) {
    readings_ = plant_.exchange(command);
    shafts_ = shafts_of(topology_, readings_);
  }
  ++tick_;
}

std::optional<hardware::ImuSample> EmulatedRobot::imu() const {
  if (!imu_on_) return std::nullopt;
  return hardware::ImuSample{.time_ns = static_cast<std::uint64_t>(imu_reading_.stamp.nanoseconds),
                             .rate = imu_reading_.w_WB_B,
                             .force = imu_reading_.f_B};
}

}  // namespace hopscotch::apps
