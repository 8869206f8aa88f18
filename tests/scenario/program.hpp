#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

/// Runs the program as a user does.
namespace hopscotch::apps {

struct Answer {
  int status = -1;
  std::string output;  ///< Standard output and standard error.
};

/// @param arguments Of the program, as for a shell.
inline Answer call_program(const std::string& program, const std::string& arguments) {
  const std::string line = program + " " + arguments + " 2>&1";
  std::FILE* pipe = popen(line.c_str(), "r");
  if (pipe == nullptr) return {};
  Answer answer;
  std::array<char, 4096> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;) {
    answer.output.append(block.data(), n);
  }
  const int status = pclose(pipe);
  answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return answer;
}

/// The same for our own program.
inline Answer call(const std::string& arguments) {
  return call_program(HOPSCOTCH_PROGRAM, arguments);
}

}  // namespace hopscotch::apps
