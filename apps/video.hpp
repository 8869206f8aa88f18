#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "apps/run_folder.hpp"
#include "core/robot_state.hpp"

namespace hopscotch::apps {

/// A film of a simulated world as it grows, in real time, through the program ffmpeg.
class Film {
 public:
  static constexpr double kStep = 1.0 / 30.0;  ///< Between pictures [s].

  /// @param mjcf Of the world, as of `sim::scene_mjcf`.
  /// @throws sim::RendererUnavailable if this machine cannot draw or has no ffmpeg.
  Film(const std::string& mjcf, const std::filesystem::path& file);
  ~Film();

  /// The next picture. @throws std::runtime_error if ffmpeg stopped listening.
  void add(const core::RobotState& state, const std::string& caption);
  /// Ends the film; only now it has its name. @throws std::runtime_error if ffmpeg failed.
  void finish();

 private:
  struct Studio;
  std::unique_ptr<Studio> studio_;
};

/// Draws a finished run as `video.mp4`, in real time, with time, phase and jump written in; through
/// the program ffmpeg. Needs result.json, run.lcm, robot.yaml and scene.xml of the folder.
/// @throws sim::RendererUnavailable if this machine cannot draw or has no ffmpeg;
///         std::runtime_error for files.
void write_video(const RunFolder& folder);

}  // namespace hopscotch::apps
