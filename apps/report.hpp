#pragma once

#include <filesystem>

namespace hopscotch::apps {

/// Writes `report.html` of a run folder: one self-contained page with the result, the side view
/// with a replay, every jump, the target choices, motors and forces against their limits, computing
/// times, and the key frames if `frames` holds some. Reads result.json, run.lcm and robot.yaml.
/// @throws std::runtime_error, core::ConfigError naming the file that is missing or wrong.
void write_report(const std::filesystem::path& run_dir);

}  // namespace hopscotch::apps
