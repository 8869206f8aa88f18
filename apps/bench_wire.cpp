#include "apps/bench.hpp"
#include "apps/installation.hpp"
#include "apps/stopwatch.hpp"
#include "hardware/bus_topology.hpp"
#include "hardware/drive_map.hpp"
#include "hardware/motor_protocol.hpp"

namespace hopscotch::apps {

/// Set-points of ten joints to frames and ten answers back to joints, with the linkage.
nlohmann::ordered_json bench_wire() {
  const hardware::BusTopology topology = hardware::BusTopology::load(
      core::ConfigReader::from_file(config_directory() / "robot_bus.yaml"),
      config_directory() / "drives");
  core::JointCommand command;
  command.mode = core::DriveMode::active;
  command.kp.setConstant(150.0);
  command.kd.setConstant(2.0);
  core::JointVector q = core::JointVector::LinSpaced(-0.3, 0.3);
  const core::JointVector dq = core::JointVector::Zero();
  hardware::DriveReply answer;
  answer.speed = answer.torque = 0.0;
  answer.temperature_degC = answer.rotor_temperature_degC = 40.0;
  std::vector<double> times_us;
  constexpr int kBatches = 2000;
  constexpr int kPerBatch = 100;  // one alone is shorter than the clock is fine
  for (int batch = 0; batch < kBatches; ++batch) {
    const Stopwatch watch(TimeOf::thread);
    for (int i = 0; i < kPerBatch; ++i) {
      command.q = q;
      command.q[3] += 1e-4 * i;
      const auto setpoints = hardware::drive_setpoints(topology, command, q, dq);
      hardware::ShaftStates shafts;
      for (std::size_t joint = 0; joint < core::kJoints; ++joint) {
        const hardware::DriveMount& drive = topology.drives[joint];
        hardware::CanFrame frame;
        static_cast<void>(
            hardware::encode_setpoint(drive.family, drive.id, setpoints[joint], frame));
        frame.data[0] = static_cast<std::uint8_t>(0x10U | drive.id);  // an enabled Damiao's answer
        static_cast<void>(hardware::decode_reply(drive.family, frame, answer));
        shafts.position[joint] = answer.position;
        shafts.speed[joint] = answer.speed;
        shafts.torque[joint] = answer.torque;
      }
      // What was read goes into the next command: nothing of this can be left out.
      q = 0.999 * q +
          1e-3 * hardware::joint_states(topology, shafts).q.cwiseMax(-1.0).cwiseMin(1.0);
    }
    times_us.push_back(1e3 * watch.milliseconds() / kPerBatch);
  }
  return {{"n", times_us.size()}, {"ten_joints_us", percentile_group(times_us, 1.0)}};
}

}  // namespace hopscotch::apps
