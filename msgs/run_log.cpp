#include "msgs/run_log.hpp"

#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <string>

#include "core/check.hpp"
#include "msgs/dispatcher.hpp"
#include "msgs/event.hpp"

namespace hopscotch::msgs {

namespace {
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;  // LCM logs count microseconds
}

struct RunLogWriter::File {
  File(const std::filesystem::path& file, std::uint64_t id)
      : name(file.string()), log(name, "w"), maker(id) {
    if (!log.good()) throw std::runtime_error("cannot write " + name);
  }

  void append(const Event& source) {
    Bytes bytes = source.bytes;  // the library's event points to bytes that it could change
    lcm::LogEvent event;
    event.eventnum = 0;  // the library numbers events itself
    event.timestamp = source.now.nanoseconds / kNanosecondsPerMicrosecond;
    event.channel = source.channel;
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.data = bytes.data();
    if (log.writeEvent(&event) != 0) throw std::runtime_error("cannot write " + name);
  }

  std::string name;
  lcm::LogFile log;
  EventMaker maker;
};

RunLogWriter::RunLogWriter(const std::filesystem::path& file, std::uint64_t run_id)
    : file_(std::make_unique<File>(file, run_id)) {}
RunLogWriter::~RunLogWriter() = default;
RunLogWriter::RunLogWriter(RunLogWriter&&) noexcept = default;
RunLogWriter& RunLogWriter::operator=(RunLogWriter&&) noexcept = default;

void RunLogWriter::write(const Event& event) {
  file_->append(event);
}
void RunLogWriter::write(core::Stamp now, const core::SensorReadings& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const core::RobotState& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const core::JointCommand& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const core::JumpPlan& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const core::OneStepTerrain& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const MapView& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const core::TargetChoice& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const DepthRecord& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const AnchorRecord& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const TargetQuestion& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const TargetCommand& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const ModeCommand& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const Ack& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const Status& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const Truth& value) {
  file_->append(file_->maker.make(now, value));
}
void RunLogWriter::write(core::Stamp now, const Scene& value) {
  file_->append(file_->maker.make(now, value));
}

void RunLogWriter::close() {
  HOPSCOTCH_CHECK(file_ != nullptr);
  const bool flushed = std::fflush(file_->log.getFilePtr()) == 0;
  const std::string name = file_->name;
  file_.reset();
  if (!flushed) throw std::runtime_error("cannot write " + name);
}

RunLogSummary read_run_log(const std::filesystem::path& file, const RunLogHandlers& handlers) {
  lcm::LogFile log(file.string(), "r");
  if (!log.good()) throw std::runtime_error("cannot read " + file.string());
  Dispatcher dispatcher(handlers);
  std::uintmax_t bytes = 0;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    constexpr std::uintmax_t kEventHeader = 28;
    bytes += kEventHeader + event->channel.size() + static_cast<std::uintmax_t>(event->datalen);
    dispatcher.take(
        {event->timestamp * kNanosecondsPerMicrosecond}, event->channel,
        {static_cast<const std::uint8_t*>(event->data), static_cast<std::size_t>(event->datalen)});
  }
  RunLogSummary summary = dispatcher.summary();
  summary.cut_short = bytes != std::filesystem::file_size(file);
  return summary;
}

}  // namespace hopscotch::msgs
