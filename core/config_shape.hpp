#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hopscotch::core {

/// What kind of value stands at a key.
enum class ConfigShape : std::uint8_t { absent, scalar, list, mapping };

struct ConfigValue {
  ConfigShape shape = ConfigShape::absent;
  std::vector<std::string>
      words;  ///< Of a list, as written; empty text for what is no plain value.
};

/// Looks at one place of a YAML text before it is read strictly: for keys that may hold a value, a
/// list or a mapping, and for lists of words.
/// @param path Keys from the root on.
/// @throws ConfigError if the text is no YAML mapping.
[[nodiscard]] ConfigValue value_at(std::string_view text, const std::vector<std::string>& path);

}  // namespace hopscotch::core
