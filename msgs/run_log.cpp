#include "msgs/run_log.hpp"

#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/check.hpp"
#include "msgs/channels.hpp"

namespace hopscotch::msgs {

namespace {
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;  // LCM logs count microseconds
}

struct RunLogWriter::File {
  File(const std::filesystem::path& file, std::uint64_t id)
      : name(file.string()), log(name, "w"), run_id(id) {
    if (!log.good()) throw std::runtime_error("cannot write " + name);
  }

  template <typename Value>
  void append(core::Stamp now, std::string_view channel, const Value& value) {
    Bytes bytes = encode(value, {++sequences[channel], run_id});
    lcm::LogEvent event;
    event.eventnum = 0;  // the library numbers events itself
    event.timestamp = now.nanoseconds / kNanosecondsPerMicrosecond;
    event.channel = channel;
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.data = bytes.data();
    if (log.writeEvent(&event) != 0) throw std::runtime_error("cannot write " + name);
  }

  std::string name;
  lcm::LogFile log;
  std::uint64_t run_id;
  std::map<std::string_view, std::uint64_t> sequences;  // per channel; the names are static
};

RunLogWriter::RunLogWriter(const std::filesystem::path& file, std::uint64_t run_id)
    : file_(std::make_unique<File>(file, run_id)) {}
RunLogWriter::~RunLogWriter() = default;
RunLogWriter::RunLogWriter(RunLogWriter&&) noexcept = default;
RunLogWriter& RunLogWriter::operator=(RunLogWriter&&) noexcept = default;

void RunLogWriter::write(core::Stamp now, const core::SensorReadings& value) {
  file_->append(now, kSensorsChannel, value);
}
void RunLogWriter::write(core::Stamp now, const core::RobotState& value) {
  file_->append(now, kStateChannel, value);
}
void RunLogWriter::write(core::Stamp now, const core::JointCommand& value) {
  file_->append(now, kCommandChannel, value);
}
void RunLogWriter::write(core::Stamp now, const core::JumpPlan& value) {
  file_->append(now, kPlanChannel, value);
}
void RunLogWriter::write(core::Stamp now, const core::OneStepTerrain& value) {
  file_->append(now, kTerrainChannel, value);
}
void RunLogWriter::write(core::Stamp now, const core::TargetChoice& value) {
  file_->append(now, kTargetChannel, value);
}
void RunLogWriter::write(core::Stamp now, const TargetCommand& value) {
  file_->append(now, kTargetCommandChannel, value);
}
void RunLogWriter::write(core::Stamp now, const ModeCommand& value) {
  file_->append(now, kModeCommandChannel, value);
}
void RunLogWriter::write(core::Stamp now, const Ack& value) {
  file_->append(now, kAckChannel, value);
}
void RunLogWriter::write(core::Stamp now, const Status& value) {
  file_->append(now, kStatusChannel, value);
}
void RunLogWriter::write(core::Stamp now, const Truth& value) {
  file_->append(now, kTruthChannel, value);
}
void RunLogWriter::write(core::Stamp now, const Scene& value) {
  file_->append(now, kSceneChannel, value);
}

void RunLogWriter::close() {
  HOPSCOTCH_CHECK(file_ != nullptr);
  const bool flushed = std::fflush(file_->log.getFilePtr()) == 0;
  const std::string name = file_->name;
  file_.reset();
  if (!flushed) throw std::runtime_error("cannot write " + name);
}

namespace {

/// Hands events of one channel over to their handler.
class Dispatcher {
 public:
  explicit Dispatcher(RunLogSummary& summary) : summary_(summary) {}

  template <typename Value>
  void on(std::string_view channel, const RunLogHandlers::Handler<Value>& handler) {
    entries_[channel] = [this, &handler](core::Stamp written, std::span<const std::uint8_t> bytes) {
      if (!handler) return;
      if (const auto message = decode<Value>(bytes)) {
        handler(written, *message);
      } else {
        ++summary_.malformed;
      }
    };
  }

  void take(const lcm::LogEvent& event) {
    ++summary_.events;
    const auto entry = entries_.find(event.channel);
    if (entry == entries_.end()) {
      ++summary_.unknown;
      return;
    }
    entry->second(
        {event.timestamp * kNanosecondsPerMicrosecond},
        {static_cast<const std::uint8_t*>(event.data), static_cast<std::size_t>(event.datalen)});
  }

 private:
  RunLogSummary& summary_;
  std::map<std::string_view, std::function<void(core::Stamp, std::span<const std::uint8_t>)>>
      entries_;
};

}  // namespace

RunLogSummary read_run_log(const std::filesystem::path& file, const RunLogHandlers& handlers) {
  lcm::LogFile log(file.string(), "r");
  if (!log.good()) throw std::runtime_error("cannot read " + file.string());
  RunLogSummary summary;
  Dispatcher dispatcher(summary);
  dispatcher.on(kSensorsChannel, handlers.sensors);
  dispatcher.on(kStateChannel, handlers.state);
  dispatcher.on(kCommandChannel, handlers.command);
  dispatcher.on(kPlanChannel, handlers.plan);
  dispatcher.on(kTerrainChannel, handlers.terrain);
  dispatcher.on(kTargetChannel, handlers.target);
  dispatcher.on(kTargetCommandChannel, handlers.target_command);
  dispatcher.on(kModeCommandChannel, handlers.mode_command);
  dispatcher.on(kAckChannel, handlers.ack);
  dispatcher.on(kStatusChannel, handlers.status);
  dispatcher.on(kTruthChannel, handlers.truth);
  dispatcher.on(kSceneChannel, handlers.scene);
  while (const lcm::LogEvent* event = log.readNextEvent()) dispatcher.take(*event);
  return summary;
}

}  // namespace hopscotch::msgs
