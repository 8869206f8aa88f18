#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "planner/jump_library.hpp"

namespace hopscotch::apps {

/// `<config>/jumps/<robot>.jumps`, which `hopscotch library` writes.
[[nodiscard]] std::filesystem::path jumps_file(const std::string& robot);

/// The library of jumps of a robot; empty where none is shipped.
/// @throws core::ConfigError naming the file if it is broken, or was compiled for another robot or
///         for another number of steps than `steps`.
[[nodiscard]] std::shared_ptr<const planner::JumpLibrary> shipped_jumps(
    const std::string& robot, const planner::StepCounts& steps);

/// The same of any file.
[[nodiscard]] planner::JumpLibrary read_jumps(const std::filesystem::path& file);

}  // namespace hopscotch::apps
