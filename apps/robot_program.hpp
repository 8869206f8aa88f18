#pragma once

#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
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
#include "apps/robot_voice.hpp"
#include "apps/stage.hpp"
#include "apps/step_link.hpp"
#include "hardware/can_bus.hpp"
#include "hardware/imu.hpp"

namespace hopscotch::apps {

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
  void refuse_to_slow_a_robot_down() const;
  [[nodiscard]] std::string clock_text() const;
  [[nodiscard]] bool ranges_agree();
  void attend();
  void obey(const core::OperatorCommand& command);
  void enable(const core::OperatorCommand& command);
  void answer(const core::OperatorCommand& command, const core::Refusal& refusal,
              const std::string& remark);
  [[nodiscard]] std::unique_ptr<RobotBrain> make_brain();
  void print_counters();

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
  std::unique_ptr<RobotBrain> brain_;  ///< Of the last enabling.
  std::unique_ptr<RobotBrain> spare_;  ///< For the next: to make one takes long, and memory.

  CommandBox box_;
  std::uint64_t run_id_;
  CommandGate gate_;
  LiveRun live_;
  RobotVoice voice_{config_, console_, live_};
  bool finishing_ = false;  ///< The robot is to be off, then the program ends.
  std::uint64_t exchanges_with_heap_ = 0;
  /// Takes a used brain apart and makes the next. Last, so that its thread ends before the others.
  Stage<std::unique_ptr<RobotBrain>, std::unique_ptr<RobotBrain>> spare_brains_;
};

}  // namespace hopscotch::apps
