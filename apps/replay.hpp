#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "apps/depth_image_file.hpp"
#include "apps/motion_replay.hpp"
#include "apps/program_config.hpp"
#include "apps/terrain_json.hpp"
#include "core/depth_frame.hpp"
#include "core/terrain_map.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::apps {

/// One decision made again, or one image of a folder.
struct ReplayedLook {
  TerrainReport report;
  const core::TerrainMap& map;
  const core::DepthFrame* frame = nullptr;                 ///< Newest one; null before the first.
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();  ///< Where it was taken.
  /// Against what was recorded, bit by bit; nothing when nothing was recorded.
  std::optional<bool> terrain_equal{};
  std::optional<bool> target_equal{};
};

using LookObserver = std::function<void(const ReplayedLook& look)>;

struct ReplaySummary {
  int frames = 0;
  int looks = 0;
  int terrains_differing = 0;
  int targets_differing = 0;
  int homeless_readings = 0;  ///< Of which the log does not say where the estimator began.
  Agreement states;           ///< Of the estimator.
  Agreement plans;

  [[nodiscard]] int differing() const {
    return terrains_differing + targets_differing + states.differing + plans.differing;
  }
};

/// Runs estimator and planner again on a log, and perception and target choice where it was
/// recorded with depth.
/// @throws core::ConfigError if the file is no log, holds nothing to run again, is damaged or is
///         cut short; `observe` has then seen what stands before the damage.
ReplaySummary replay_log(const std::filesystem::path& log, const ProgramConfig& config,
                         const model::RobotParameters& robot, const LookObserver& observe);

/// Runs perception on the 16-bit images of a folder in the order of their names, at the poses of a
/// text file `*pose*.txt` beside them (a line each: [stamp] tx ty tz qx qy qz qw, camera in any
/// world; an image with a number n in its name takes line n when there are more lines than images).
/// Without one the camera stood still. The first image's floor gives up and height.
/// @throws core::ConfigError naming the file that cannot be used.
ReplaySummary replay_folder(const std::filesystem::path& folder, const DepthScaling& scaling,
                            const ProgramConfig& config, const model::RobotParameters& robot,
                            const LookObserver& observe);

}  // namespace hopscotch::apps
