#include "apps/console.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <string_view>

namespace hopscotch::apps {

namespace {

constexpr std::size_t kQueueBytes = 64U << 10U;
constexpr std::size_t kQueueLines = 256;
constexpr int kPatience_ms = 500;

bool write_line(int descriptor, std::string_view line) {
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
    : outbox_(
          [descriptor](const Line& line) {
            if (line.words != nullptr) return write_line(descriptor, line.words(line) + "\n");
            return write_line(descriptor, {line.text.data(), line.size});
          },
          {.bytes = kQueueBytes, .items = kQueueLines}) {}

void Console::say(const char* format, ...) {
  Line line;
  va_list values;
  va_start(values, format);
  const int length = std::vsnprintf(line.text.data(), line.text.size() - 1, format, values);
  va_end(values);
  // A longer line is cut; the last place but one holds the end of the text.
  line.size = std::min(static_cast<std::size_t>(std::max(length, 0)), line.text.size() - 2);
  line.text[line.size++] = '\n';
  outbox_.put(line, line.size);
}

}  // namespace hopscotch::apps
