#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hopscotch::apps {

/// @throws std::runtime_error naming the file.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// Writes beside the file first and renames, so that it is whole or not there.
/// @throws std::runtime_error naming the file.
void write_file_atomically(const std::filesystem::path& file, std::string_view content);

}  // namespace hopscotch::apps
