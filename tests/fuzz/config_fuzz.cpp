// Any text: ConfigReader reads it or throws ConfigError, and says where. Nothing else may happen.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/check.hpp"
#include "core/config_reader.hpp"

namespace {

using hopscotch::core::ConfigError;
using hopscotch::core::ConfigReader;

template <typename Action>
void expect_value_or_config_error(const Action& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    HOPSCOTCH_CHECK(std::string_view(error.what()).starts_with("fuzz.yaml"));
  }
}

/// Asks for every key as every type, and goes down into sections.
void read_everything(const ConfigReader& reader, int depth) {
  constexpr int kDepthMax = 8;
  if (depth > kDepthMax) return;
  for (const std::string& key : reader.keys()) {
    HOPSCOTCH_CHECK(reader.has(key));
    expect_value_or_config_error([&] { static_cast<void>(reader.number(key)); });
    expect_value_or_config_error([&] { static_cast<void>(reader.integer(key, -5, 5)); });
    expect_value_or_config_error([&] { static_cast<void>(reader.flag(key)); });
    expect_value_or_config_error([&] { static_cast<void>(reader.text(key)); });
    expect_value_or_config_error([&] { static_cast<void>(reader.choice(key, {"a", "b"})); });
    expect_value_or_config_error([&] { static_cast<void>(reader.number_list(key)); });
    expect_value_or_config_error([&] { read_everything(reader.section(key), depth + 1); });
    expect_value_or_config_error([&] {
      for (const ConfigReader& item : reader.list(key)) read_everything(item, depth + 1);
    });
  }
  reader.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  expect_value_or_config_error(
      [&] { read_everything(ConfigReader::from_text(text, "fuzz.yaml"), 0); });
  return 0;
}
