#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>

namespace hopscotch::apps {

/// Feeds pictures to the program ffmpeg, which makes an MP4 (H.264) of them.
class VideoEncoder {
 public:
  struct Format {
    int width = 0;   ///< [pixel], even.
    int height = 0;  ///< [pixel], even.
    int rate = 30;   ///< Pictures per second.
  };

  /// @throws sim::RendererUnavailable if there is no ffmpeg on this machine.
  VideoEncoder(const std::filesystem::path& file, const Format& format);
  /// Without `finish` the half-written film is removed.
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// @param rgb width x height x 3 bytes, row by row from the top.
  /// @throws std::runtime_error if ffmpeg stopped listening.
  void add(std::span<const std::uint8_t> rgb);

  /// Ends the film; only now it has its name.
  /// @throws std::runtime_error if ffmpeg failed.
  void finish();

 private:
  /// Waits for ffmpeg to end. @return Its exit status.
  int wait();

  std::filesystem::path file_;
  std::filesystem::path beside_;  ///< Where it grows.
  int input_ = -1;
  pid_t process_ = -1;
};

}  // namespace hopscotch::apps
