#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

/// What tests of whole campaigns need: a folder of their own and the program as a process.
namespace hopscotch::tests {

namespace fs = std::filesystem;

inline std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A process of this test; it and what it wrote to `log` can be waited for.
class Process {
 public:
  Process(const std::vector<std::string>& words, const fs::path& log) {
    process_ = fork();
    if (process_ != 0) return;
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    std::FILE* file = std::fopen(log.c_str(), "w");
    dup2(fileno(file), STDOUT_FILENO);
    dup2(fileno(file), STDERR_FILENO);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  ~Process() {
    if (process_ > 0) {
      send(SIGKILL);
      wait();
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const { kill(process_, signal); }
  [[nodiscard]] pid_t id() const { return process_; }

  /// Exit status; 128 + signal if one ended it.
  int wait() {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  /// Processes that it has started and that are running.
  [[nodiscard]] std::vector<pid_t> children() const {
    const std::string id = std::to_string(process_);
    std::istringstream list(text_of("/proc/" + id + "/task/" + id + "/children"));
    std::vector<pid_t> result;
    for (pid_t child = 0; list >> child;) result.push_back(child);
    return result;
  }

 private:
  pid_t process_ = -1;
};

/// Polls until `condition` holds; false if it does not within the test's patience.
template <typename Condition>
bool eventually(const Condition& condition) {
  constexpr int kLooks = 4000;
  for (int i = 0; i < kLooks; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

/// A folder that goes with the object.
class TestFolder {
 public:
  explicit TestFolder(const std::string& name)
      : path_(fs::temp_directory_path() / ("hopscotch-" + name + "-" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~TestFolder() { fs::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  fs::path path_;
};

/// One short jump a trial on true terrain.
inline std::string short_campaign(int trials, const std::string& more = "") {
  return "name: short\n"
         "scenario: {family: flat, jumps: 1, jump_m: {grid: [0.25, 0.40]}}\n"
         "perception: truth\n"
         "state: truth\n"
         "trials: " +
         std::to_string(trials) +
         "\n"
         "keep: {failures: 0, successes: 0}\n"
         "vary: {friction: [0.4, 0.8], plant.mass_scale: [0.95, 1.05]}\n" +
         more;
}

}  // namespace hopscotch::tests
