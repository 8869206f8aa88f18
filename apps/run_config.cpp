#include "apps/run_config.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "apps/installation.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

constexpr std::string_view kTuningKey = "\nconfiguration:\n";
constexpr std::size_t kIndent = 2;

std::string indented(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    result += std::string(kIndent, ' ') + line + "\n";
  }
  return result;
}

std::string unindented(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);)
    result += line.substr(std::min(kIndent, line.size())) + "\n";
  return result;
}

}  // namespace

std::string run_config_text(const std::string& scenario, const std::string& tuning) {
  return "# Scenario and configuration of this run, as used.\nscenario:\n" + indented(scenario) +
         std::string(kTuningKey.substr(1)) + indented(tuning);
}

std::string tuning_text(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  const std::size_t at = text.find(kTuningKey);
  return at == std::string::npos ? text : unindented(text.substr(at + kTuningKey.size()));
}

std::string robot_text(const std::string& name) {
  const std::filesystem::path file = robot_file(name);
  std::string text = read_file(file);
  const auto reader = core::ConfigReader::from_text(text, file.string());
  if (reader.has("based_on")) {
    text += "base:\n" + indented(read_file(robot_file(reader.text("based_on"))));
  }
  return text;
}

std::filesystem::path believed_robot_file(const RunFolder& folder) {
  const auto scenario = core::ConfigReader::from_file(folder.config()).section("scenario");
  const std::string believed = scenario.text_or("robot", "hector");
  const auto plant = scenario.section_if("plant");
  const std::string simulated = plant ? plant->text_or("robot", believed) : believed;
  return believed == simulated ? folder.robot() : robot_file(believed);
}

}  // namespace hopscotch::apps
