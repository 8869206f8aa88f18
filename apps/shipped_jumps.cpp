#include "apps/shipped_jumps.hpp"

#include <stdexcept>

#include "apps/installation.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

std::string text_of(const planner::StepCounts& steps) {
  return std::to_string(steps.takeoff) + " + " + std::to_string(steps.flight) + " + " +
         std::to_string(steps.landing) + " steps";
}

}  // namespace

std::filesystem::path jumps_file(const std::string& robot) {
  return config_directory() / "jumps" / (robot + ".jumps");
}

planner::JumpLibrary read_jumps(const std::filesystem::path& file) {
  try {
    return planner::JumpLibrary::from_bytes(read_file(file));
  } catch (const std::invalid_argument& error) {
    throw core::ConfigError(file.string() + ": " + error.what());
  }
}

std::shared_ptr<const planner::JumpLibrary> shipped_jumps(const std::string& robot,
                                                          const planner::StepCounts& steps) {
  const std::filesystem::path file = jumps_file(robot);
  if (!std::filesystem::exists(file)) return nullptr;
  auto library = std::make_shared<const planner::JumpLibrary>(read_jumps(file));
  if (library->robot() != robot) {
    throw core::ConfigError(file.string() + ": compiled for " + library->robot());
  }
  if (!library->fits(steps)) {
    throw core::ConfigError(file.string() + ": jumps of " + text_of(library->steps()) +
                            ", but planner.steps asks for " + text_of(steps) +
                            "; compile it anew with `hopscotch library --robot " + robot + "`");
  }
  return library;
}

}  // namespace hopscotch::apps
