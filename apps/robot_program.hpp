#pragma once

#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/command_gate.hpp"
#include "apps/commands.hpp"
#include "apps/console.hpp"
#include "apps/depth_inbox.hpp"
#include "apps/live_run.hpp"
#include "apps/real_time.hpp"
#include "apps/robot_brain.hpp"
#include "apps/robot_config.hpp"
#include "apps/robot_session.hpp"
#include "apps/step_link.hpp"
#include "hardware/can_bus.hpp"
#include "hardware/imu.hpp"

namespace hopscotch::apps {

/// Says again, by the wall clock, what was said last: in lock-step time the loop can be silent for
/// seconds while a jump is planned, and whoever waits for an answer must not think it gone.
class Heartbeat {
 public:
  /// @param live Outlives this object.
  explicit Heartbeat(LiveRun& live);
  void remember(const msgs::Event& event);

 private:
  std::mutex mutex_;
  std::optional<msgs::Event> last_;
  std::jthread thread_;  // last, so that it ends before what it uses
};

/// `hopscotch robot`: buses, IMU, session and operator in one loop. Nothing moves but on the
/// operator's word, and every word gets an answer.
class RobotProgram {
 public:
  enum class Wire : std::uint8_t {
    drive,
    listen,  ///< Drives are read and never enabled.
  };

  /// @throws core::ConfigError; std::runtime_error naming the device that is missing and the fix.
  RobotProgram(const RobotConfig& config, Wire wire);

  /// Until the operator's `stop` has been carried out, or an interrupt: then the robot is brought
  /// to rest first.
  ExitStatus run(const std::atomic<bool>& interrupted);

 private:
  [[nodiscard]] hardware::PlantPorts make_ports();
  void start_time();
  [[nodiscard]] bool ranges_agree();
  void attend();
  void obey(const core::OperatorCommand& command);
  void enable(const core::OperatorCommand& command);
  void answer(const core::OperatorCommand& command, const core::Refusal& refusal,
              const std::string& remark);
  void send(const core::OperatorAnswer& answer);
  template <typename Value>
  void publish(const Value& value);
  void tell_progress();
  void tell_status();
  void print_joints();
  void print_counters();
  [[nodiscard]] std::string fault_text() const;

  RobotConfig config_;
  Wire wire_;
  Console console_{STDOUT_FILENO};
  std::vector<hardware::CanBus> buses_;
  hardware::SerialImu imu_;
  std::optional<StepGranter> step_;   ///< In lock-step ...
  std::optional<PeriodicWake> wake_;  ///< ... or in real time.
  core::Stamp now_;
  bool world_gone_ = false;
  hardware::RobotPlant plant_;
  RobotSession session_;
  std::optional<DepthInbox> eyes_;
  std::unique_ptr<RobotBrain> brain_;

  CommandBox box_;
  std::uint64_t run_id_;
  CommandGate gate_;
  LiveRun live_;
  Heartbeat heartbeat_{live_};
  msgs::EventMaker events_;
  bool finishing_ = false;  ///< The robot is to be off, then the program ends.
  core::Stamp told_;        ///< Last status.
  core::Stamp printed_;     ///< Last table of joints.
  SessionStage told_stage_ = SessionStage::off;
  int told_jumps_ = 0;
};

}  // namespace hopscotch::apps
