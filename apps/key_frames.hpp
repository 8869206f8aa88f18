#pragma once

#include <optional>
#include <string>

#include "apps/run_folder.hpp"

namespace hopscotch::apps {

inline constexpr const char* kCrossingPicture = "crossing.png";

/// Draws the key frames of a finished run into its `frames` folder: `<jump>-<n>-<instant>.png` for
/// crouch, lift-off, apex, touchdown and rest of every jump, and `crossing.png`, the robot at many
/// moments in one picture. Needs result.json, run.lcm, robot.yaml and scene.xml of the folder.
/// @return Nothing, or why this machine cannot draw; the report then goes without pictures.
/// @throws std::runtime_error for files.
std::optional<std::string> draw_key_frames(const RunFolder& folder);

}  // namespace hopscotch::apps
