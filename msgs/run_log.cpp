#include "msgs/run_log.hpp"

#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <string>

#include "core/check.hpp"
#include "msgs/dispatcher.hpp"

namespace hopscotch::msgs {

namespace {
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;  // LCM logs count microseconds
}

struct RunLogWriter::File {
  explicit File(const std::filesystem::path& file) : name(file.string()), log(name, "w") {
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
};

RunLogWriter::RunLogWriter(const std::filesystem::path& file, std::uint64_t run_id)
    : maker_(run_id), file_(std::make_unique<File>(file)) {}
RunLogWriter::~RunLogWriter() = default;
RunLogWriter::RunLogWriter(RunLogWriter&&) noexcept = default;
RunLogWriter& RunLogWriter::operator=(RunLogWriter&&) noexcept = default;

void RunLogWriter::write(const Event& event) {
  file_->append(event);
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
