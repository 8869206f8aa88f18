#pragma once

#include <filesystem>

/// Names of the files in a run folder.
namespace hopscotch::apps {

struct RunFolder {
  std::filesystem::path path;

  [[nodiscard]] std::filesystem::path result() const { return path / "result.json"; }
  [[nodiscard]] std::filesystem::path log() const { return path / "run.lcm"; }
  /// Scenario and tuning as used.
  [[nodiscard]] std::filesystem::path config() const { return path / "config.yaml"; }
  /// Robot file as used; report and video draw by it.
  [[nodiscard]] std::filesystem::path robot() const { return path / "robot.yaml"; }
  /// The simulated world; key frames and video are rendered from it.
  [[nodiscard]] std::filesystem::path scene() const { return path / "scene.xml"; }
  [[nodiscard]] std::filesystem::path report() const { return path / "report.html"; }
  [[nodiscard]] std::filesystem::path video() const { return path / "video.mp4"; }
  /// Key frames, `<jump>-<instant>.png`.
  [[nodiscard]] std::filesystem::path frames() const { return path / "frames"; }
  /// After a fall or fault: a run folder with the last seconds of all channels but depth.
  [[nodiscard]] std::filesystem::path black_box() const { return path / "black-box"; }
};

/// @throws core::ConfigError naming the file that is missing: result, log or robot.
void require_run_folder(const RunFolder& folder);

}  // namespace hopscotch::apps
