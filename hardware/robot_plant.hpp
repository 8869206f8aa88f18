#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/control_status.hpp"
#include "core/plant.hpp"
#include "hardware/bus_topology.hpp"
#include "hardware/can_port.hpp"
#include "hardware/command_guard.hpp"
#include "hardware/drive_map.hpp"
#include "hardware/imu.hpp"
#include "hardware/motor_protocol.hpp"

namespace hopscotch::hardware {

/// What the plant takes for a fault; section `plant` of the bus file.
struct RobotPlantConfig {
  CommandGuardConfig guard;
  int stale_cycles_ground = 0;      ///< Exchanges without an answer of a drive: fault.
  int stale_cycles_flight = 0;      ///< The same in flight.
  double imu_age_max = 0.0;         ///< [s]
  double temperature_max_degC = 0;  ///< Of transistors or winding.
  double stuck_time = 0.0;     ///< A position that stays bit for bit the same for so long [s] ...
  double stuck_travel = 0.0;   ///< ... while the joint should have turned so far: fault [rad].
  double start_damping = 0.0;  ///< kd of drives that are on while others are not yet [N·m·s/rad].

  static RobotPlantConfig load(const core::ConfigReader& section);
};

/// What the plant needs of the world. None of them may allocate or throw; only `wait` may block.
struct PlantPorts {
  std::vector<CanPort> buses;  ///< In the topology's order.
  /// The newest message of the IMU in axes of B that has come since the last call.
  std::function<std::optional<ImuSample>()> imu;
  /// Waits for the end of the exchange period; returns its time on the robot's clock.
  std::function<core::Stamp()> wait;
};

/// What is wrong with a bus.
enum class BusTrouble : std::uint8_t {
  none,
  off,            ///< Its controller has left the bus.
  passive,        ///< So many errors that its controller may no longer report them.
  not_taken,      ///< The interface refused a frame: its queue is full, or it is down.
  not_confirmed,  ///< Frames of earlier exchanges are not on the wire yet.
};

/// The first thing that went wrong.
struct PlantFault {
  core::Reason reason = core::Reason::none;
  int joint = -1;  ///< -1: no joint in particular.
  int bus = -1;    ///< -1: no bus in particular.
  DriveFault drive = DriveFault::none;
  BusTrouble trouble = BusTrouble::none;
};
/// e.g. "left_knee on can1 reports over-temperature".
[[nodiscard]] std::string describe(const PlantFault& fault, const BusTopology& topology);

/// Since the start.
struct PlantCounters {
  std::uint64_t exchanges = 0;
  std::uint64_t replies = 0;
  std::uint64_t lost_replies = 0;  ///< Commands without an answer by the end of their period.
  std::uint64_t malformed = 0;     ///< Frames that no drive of this robot can have sent so.
  std::uint64_t wrong_sender = 0;  ///< Answers whose content names another drive.
  std::uint64_t implausible = 0;   ///< Positions that no joint can have come to; not used.
  std::uint64_t clamped = 0;       ///< Set-points beyond the range of the wire.
  std::uint64_t not_sent = 0;      ///< Frames that the interface did not take.
  std::uint64_t bus_errors = 0;    ///< Error reports.
  std::uint64_t foreign = 0;       ///< Commands to our drives that somebody else sent.
};

/// What is known of one drive.
struct DriveReport {
  bool heard = false;  ///< Has ever answered.
  bool on = false;     ///< In motor mode, as far as it tells.
  int age = 0;         ///< Exchanges since its last answer.
  double temperature_degC = core::kNaN;
};

enum class DrivePower : std::uint8_t { off, on };

/// HECTOR on CAN: the plant of the simulation, on the wire. Every exchange passes the command
/// guard, turns joints into drives, writes all commands of all buses at once and takes what has
/// come when the period ends: the answers to this exchange's commands. A joint whose answer is
/// missing keeps its last values. Faults are latched while the power is on; the plant goes on
/// exchanging, the caller brings the robot to rest.
///
/// Real-time: `exchange` does not allocate, lock or throw; it blocks in `PlantPorts::wait` only.
class RobotPlant final : public core::Plant {
 public:
  RobotPlant(const RobotPlantConfig& config, const BusTopology& topology,
             const model::RobotParameters& robot, PlantPorts ports);

  /// @return Readings with the stamp of the beginning of the period, when the drives sampled. NaN
  /// for what was never measured. Without power the command counts for nothing: the drives are told
  /// to stay off, and answer.
  core::SensorReadings exchange(const core::JointCommand& command) override;

  /// Turns the drives on, one exchange after the other, or off at once.
  void set_power(DrivePower power) noexcept;
  /// Every drive has been turned on.
  [[nodiscard]] bool powered() const { return started_; }

  /// In flight a drive may be silent a little longer.
  void notify_phase(core::RobotPhase phase) noexcept { phase_ = phase; }

  [[nodiscard]] const PlantFault& fault() const { return fault_; }
  /// Forgets the fault and, where the drives know such a command, clears theirs.
  void clear_fault() noexcept;

  [[nodiscard]] const PlantCounters& counters() const { return counters_; }
  [[nodiscard]] const GuardCounters& guard_counters() const { return guard_.counters(); }
  [[nodiscard]] const std::array<DriveReport, core::kJoints>& drives() const { return reports_; }

 private:
  static constexpr std::size_t kBusesMax = 10;
  static constexpr std::size_t kIdentifiers = 128;
  /// Of one bus: this exchange's frames, and how many frames are not confirmed yet.
  struct Outbox {
    std::array<CanFrame, core::kJoints> frames;
    std::size_t count = 0;
    std::size_t unconfirmed = 0;
  };
  struct Drive {
    double position = core::kNaN;  // of the shaft [rad]
    double speed = 0.0;
    double torque = 0.0;
    bool fresh = false;         // answered in this exchange
    int wrong_senders = 0;      // in a row
    int enter_frames = 0;       // sent since power was asked for
    double still_travel = 0.0;  // travel asked for since the position last changed [rad]
    double still_time = 0.0;    // [s]
    std::optional<DriveFault> fault;
    double temperature_degC = core::kNaN;
  };

  void write_commands(const core::JointCommand& command);
  [[nodiscard]] CanFrame frame_for(std::size_t joint, const DriveSetpoint& setpoint) noexcept;
  void read_buses();
  void read_event(std::size_t bus, const CanEvent& event);
  void read_reply(std::size_t joint, const CanFrame& frame);
  [[nodiscard]] bool plausible(std::size_t joint, const DriveReply& reply) const;
  void watch_encoder(std::size_t joint, const DriveReply& reply);
  void read_imu();
  void close_exchange();
  void find_faults();
  void latch(const PlantFault& fault) noexcept;
  [[nodiscard]] core::SensorReadings readings(core::Stamp stamp) const;

  RobotPlantConfig config_;
  BusTopology topology_;
  PlantPorts ports_;
  CommandGuard guard_;
  double period_;                                                            // [s]
  std::array<std::array<std::int8_t, kIdentifiers>, kBusesMax> joint_of_{};  // by reply; -1: nobody
  std::array<Outbox, kBusesMax> outboxes_{};
  std::array<Drive, core::kJoints> drives_{};
  std::array<DriveReport, core::kJoints> reports_{};
  std::array<DriveSetpoint, core::kJoints> setpoints_{};
  core::JointVector q_ = core::JointVector::Constant(core::kNaN);
  core::JointVector dq_ = core::JointVector::Constant(core::kNaN);
  core::JointVector tau_ = core::JointVector::Constant(core::kNaN);
  std::optional<ImuSample> imu_;
  core::Stamp imu_stamp_;
  core::Stamp now_;
  bool clock_runs_ = false;
  DrivePower power_ = DrivePower::off;
  bool started_ = false;  // all drives have been on since power was asked for
  int clear_frames_ = 0;
  core::RobotPhase phase_ = core::RobotPhase::stand;
  PlantFault fault_;
  PlantCounters counters_;
};

}  // namespace hopscotch::hardware
