#include "apps/campaign/external_command.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

#include "apps/stopwatch.hpp"

namespace hopscotch::apps::campaign {

namespace {

constexpr int kNoProgram = 127;

[[noreturn]] void become(const std::vector<std::string>& words, int output) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  setpgid(0, 0);  // the terminal's Ctrl-C is for the campaign
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execvp(arguments[0], arguments.data());
  _exit(kNoProgram);
}

/// Reads until the end of the stream; false if the time is over first.
bool read_all(int file, double timeout, std::string& text) {
  const Stopwatch watch;
  while (true) {
    const double left_ms = 1e3 * timeout - watch.milliseconds();
    if (left_ms <= 0.0) return false;
    pollfd wait{.fd = file, .events = POLLIN, .revents = 0};
    if (poll(&wait, 1, static_cast<int>(left_ms) + 1) <= 0) continue;
    std::array<char, 4096> block{};
    const ssize_t n = read(file, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return true;
    text.append(block.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace

CommandAnswer call(const std::vector<std::string>& words, double timeout) {
  std::array<int, 2> ends{};
  CommandAnswer answer;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return answer;
  const pid_t process = fork();
  if (process == 0) become(words, ends[1]);
  close(ends[1]);
  if (process > 0) {
    answer.timed_out = !read_all(ends[0], timeout, answer.output);
    if (answer.timed_out) kill(process, SIGKILL);
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    const bool ran = !answer.timed_out && WIFEXITED(status) && WEXITSTATUS(status) != kNoProgram;
    if (ran) answer.status = WEXITSTATUS(status);
  }
  close(ends[0]);
  return answer;
}

}  // namespace hopscotch::apps::campaign
