#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hopscotch::apps {

/// Version and source revision, e.g. "0.1.0 (1a2b3c4)".
[[nodiscard]] std::string_view program_version();

/// Where `hopscotch.yaml`, `robots/` and `scenarios/` are: beside an installed program, else in the
/// source tree it was built from.
[[nodiscard]] std::filesystem::path config_directory();

/// Where the files of the web page are: beside an installed program, else where it was built.
[[nodiscard]] std::filesystem::path page_directory();

/// `<config>/robots/<name>.yaml`.
/// @throws core::ConfigError listing the known robots if there is none of that name.
[[nodiscard]] std::filesystem::path robot_file(const std::string& name);

}  // namespace hopscotch::apps
