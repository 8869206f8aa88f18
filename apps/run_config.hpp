#pragma once

#include <filesystem>
#include <string>

#include "apps/run_folder.hpp"

/// What a run folder keeps of the files that its run was made from, and how it is read back.
namespace hopscotch::apps {

/// `config.yaml` of a run folder.
/// @param tuning Text of a file like `hopscotch.yaml`.
[[nodiscard]] std::string run_config_text(const std::string& scenario, const std::string& tuning);

/// Text of the tuning in a file like `hopscotch.yaml`, or in the `config.yaml` of a run.
/// @throws std::runtime_error naming the file if it cannot be read.
[[nodiscard]] std::string tuning_text(const std::filesystem::path& file);

/// A robot's file as text that needs no other one: the robot that it is based on stands in it.
/// @throws core::ConfigError if there is no robot of that name.
[[nodiscard]] std::string robot_text(const std::string& name);

/// File of the robot that the controller of a run worked with: the folder's own where the simulated
/// robot was the same one, else the installed one.
/// @throws core::ConfigError naming the file that is missing or broken.
[[nodiscard]] std::filesystem::path believed_robot_file(const RunFolder& folder);

}  // namespace hopscotch::apps
