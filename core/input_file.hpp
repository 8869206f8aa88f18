#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/config_reader.hpp"

namespace hopscotch::core {

/// The bytes of a file that a person named; none if it is empty.
/// @param size_max  [MiB]
/// @throws ConfigError naming the file if there is none, if it is no regular file, larger or
///         unreadable.
[[nodiscard]] std::string read_input_file(const std::filesystem::path& file,
                                          std::uintmax_t size_max = 1024);

/// A name that folders get too: 1 to 100 letters, digits, '-', '_' or '.', but no '.' in front.
/// @throws ConfigError naming line, key and rule.
[[nodiscard]] std::string read_plain_name(const ConfigReader& reader, std::string_view key);

}  // namespace hopscotch::core
