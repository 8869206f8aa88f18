#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "core/time.hpp"
#include "msgs/convert.hpp"
#include "msgs/event.hpp"

namespace hopscotch::msgs {

/// Writes `run.lcm`, a log that lcm-logplayer plays. One writer, one thread; not for the control
/// tick. Every event carries the run's own time, so equal runs give equal logs.
class RunLogWriter {
 public:
  /// @throws std::runtime_error if the file cannot be made.
  RunLogWriter(const std::filesystem::path& file, std::uint64_t run_id);
  ~RunLogWriter();
  RunLogWriter(RunLogWriter&&) noexcept;
  RunLogWriter& operator=(RunLogWriter&&) noexcept;

  /// Appends a message that was made elsewhere.
  /// @throws std::runtime_error if the disk refuses.
  void write(const Event& event);
  /// Appends one message on the channel of its type.
  /// @param now Moment of writing; the value keeps its own stamp.
  /// @throws std::runtime_error if the disk refuses.
  template <typename Value>
  void write(core::Stamp now, const Value& value) {
    write(maker_.make(now, value));
  }

  /// Ends the log and says so if something was not written. Without it the destructor ends the log
  /// silently.
  /// @throws std::runtime_error if the disk refuses.
  void close();

 private:
  struct File;
  EventMaker maker_;
  std::unique_ptr<File> file_;
};

/// Who gets which message of a log; channels without a handler are skipped unread.
struct RunLogHandlers {
  template <typename Value>
  using Handler = std::function<void(core::Stamp written, const Tagged<Value>& message)>;

  Handler<core::SensorReadings> sensors;
  Handler<core::RobotState> state;
  Handler<core::JointCommand> command;
  Handler<core::JumpPlan> plan;
  Handler<core::OneStepTerrain> terrain;
  Handler<core::TargetChoice> target;
  Handler<DepthRecord> depth;
  Handler<AnchorRecord> anchor;
  Handler<EstimatorPrior> prior;
  Handler<TargetQuestion> question;
  Handler<TargetCommand> target_command;
  Handler<ModeCommand> mode_command;
  Handler<Ack> ack;
  Handler<Status> status;
  Handler<Truth> truth;
  Handler<Scene> scene;
  Handler<MapView> map;
};

/// What was found in a log.
struct RunLogSummary {
  std::size_t events = 0;     ///< Of any channel.
  std::size_t unknown = 0;    ///< On channels that are not ours.
  std::size_t malformed = 0;  ///< On our channels, but not decodable; not handed over.
  bool cut_short = false;     ///< The file ends within an event, or is damaged there.
};

/// Reads a log from end to end, in the order of writing. A log that is cut short ends early,
/// and the summary says so.
/// @throws std::runtime_error if the file cannot be opened.
RunLogSummary read_run_log(const std::filesystem::path& file, const RunLogHandlers& handlers);

}  // namespace hopscotch::msgs
