// Any text: a scenario is read or refused with a ConfigError that names the file.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/check.hpp"
#include "core/config_reader.hpp"
#include "sim/scenario.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using hopscotch::sim::Scenario;
  try {
    const Scenario scenario = Scenario::from_text(std::string(data, data + size), "fuzz.yaml");
    HOPSCOTCH_CHECK(!scenario.name.empty());
    HOPSCOTCH_CHECK(scenario.goal.x.has_value() != scenario.goal.jumps.has_value());
    HOPSCOTCH_CHECK(scenario.start.drop >= 0.0);
  } catch (const hopscotch::core::ConfigError& error) {
    HOPSCOTCH_CHECK(std::string_view(error.what()).starts_with("fuzz.yaml"));
  }
  return 0;
}
