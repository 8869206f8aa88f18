#include "apps/video_encoder.hpp"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "sim/scene_renderer.hpp"

extern char** environ;  // of POSIX; no header declares it

namespace hopscotch::apps {

namespace {

std::vector<std::string> ffmpeg_arguments(const std::filesystem::path& file,
                                          const VideoEncoder::Format& format) {
  const std::string size = std::to_string(format.width) + "x" + std::to_string(format.height);
  return {"ffmpeg",   "-v",       "error",      "-y",      "-f",        "rawvideo",
          "-pix_fmt", "rgb24",    "-s",         size,      "-r",        std::to_string(format.rate),
          "-i",       "pipe:0",   "-c:v",       "libx264", "-crf",      "20",
          "-preset",  "veryfast", "-pix_fmt",   "yuv420p", "-movflags", "+faststart",
          "-f",       "mp4",      file.string()};
}

/// Starts ffmpeg with `input` as its standard input.
pid_t start_ffmpeg(const std::vector<std::string>& arguments, int input) {
  std::vector<std::string> texts = arguments;  // the interface wants them writable
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  pid_t process = -1;
  const int error = posix_spawnp(&process, "ffmpeg", &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw sim::RendererUnavailable(std::string("no video: cannot start ffmpeg (package ffmpeg): ") +
                                   std::strerror(error));
  }
  return process;
}

}  // namespace

VideoEncoder::VideoEncoder(const std::filesystem::path& file, const Format& format)
    : file_(file), beside_(file.string() + ".part") {
  // A socket instead of a pipe: writing to one that nobody reads gives an error, not a signal.
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "no channel to ffmpeg");
  }
  input_ = ends[0];
  try {
    process_ = start_ffmpeg(ffmpeg_arguments(beside_, format), ends[1]);
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
}

VideoEncoder::~VideoEncoder() {
  if (process_ < 0) return;
  wait();
  std::error_code ignored;  // nothing can be done about it here
  std::filesystem::remove(beside_, ignored);
}

void VideoEncoder::add(std::span<const std::uint8_t> rgb) {
  while (!rgb.empty()) {
    const ssize_t sent = send(input_, rgb.data(), rgb.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) {
      throw std::runtime_error("ffmpeg stopped while making " + file_.string());
    }
    rgb = rgb.subspan(static_cast<std::size_t>(sent));
  }
}

int VideoEncoder::wait() {
  close(input_);
  int status = -1;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return status;
}

void VideoEncoder::finish() {
  const int status = wait();
  if (status != 0) {
    std::error_code ignored;  // ffmpeg's failure is the error to report
    std::filesystem::remove(beside_, ignored);
    throw std::runtime_error("ffmpeg failed to make " + file_.string());
  }
  std::filesystem::rename(beside_, file_);
}

}  // namespace hopscotch::apps
