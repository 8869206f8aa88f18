#pragma once

#include <filesystem>

#include "model/robot_parameters.hpp"
#include "perception/camera_calibration.hpp"
#include "perception/perception_config.hpp"

namespace hopscotch::apps {

/// What a log recorded with `--log-depth` holds for the calibration of the camera.
/// @throws core::ConfigError if the file is no such log, is damaged or is cut short.
[[nodiscard]] perception::CalibrationData read_calibration_log(
    const std::filesystem::path& log, const perception::PerceptionConfig& config,
    const model::RobotParameters& robot);

}  // namespace hopscotch::apps
