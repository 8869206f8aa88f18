#include "apps/console.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdarg>
#include <cstdio>

namespace hopscotch::apps {

namespace {

constexpr std::size_t kQueueBytes = 64U << 10U;
constexpr int kPatience_ms = 500;

bool write_line(int descriptor, const std::string& line) {
  std::size_t written = 0;
  while (written < line.size()) {
    pollfd ready{.fd = descriptor, .events = POLLOUT, .revents = 0};
    // A pipe that is ready takes a whole line: lines are shorter than PIPE_BUF.
    if (poll(&ready, 1, kPatience_ms) <= 0) return false;
    const ssize_t more = write(descriptor, line.data() + written, line.size() - written);
    if (more <= 0) return false;
    written += static_cast<std::size_t>(more);
  }
  return true;
}

}  // namespace

Console::Console(int descriptor)
    : outbox_([descriptor](const std::string& line) { return write_line(descriptor, line); },
              kQueueBytes) {}

void Console::say(const char* format, ...) {
  std::array<char, 1024> text{};
  va_list values;
  va_start(values, format);
  std::vsnprintf(text.data(), text.size() - 1, format, values);
  va_end(values);
  std::string line(text.data());
  line += '\n';
  const std::size_t bytes = line.size();
  outbox_.put(std::move(line), bytes);
}

}  // namespace hopscotch::apps
