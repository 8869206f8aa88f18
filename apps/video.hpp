#pragma once

#include "apps/run_folder.hpp"

namespace hopscotch::apps {

/// Draws a finished run as `video.mp4`, in real time, with time, phase and jump written in; through
/// the program ffmpeg. Needs result.json, run.lcm, robot.yaml and scene.xml of the folder.
/// @throws sim::RendererUnavailable if this machine cannot draw or has no ffmpeg;
///         std::runtime_error for files.
void write_video(const RunFolder& folder);

}  // namespace hopscotch::apps
