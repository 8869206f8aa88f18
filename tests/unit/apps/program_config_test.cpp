#include "apps/program_config.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace hopscotch::apps {
namespace {

constexpr const char* kFile = HOPSCOTCH_SOURCE_DIR "/config/hopscotch.yaml";

std::vector<std::string> lines_of_shipped_file() {
  std::ifstream file(kFile);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

std::string load_error(const std::vector<std::string>& lines) {
  // A file for each test: ctest runs them side by side.
  const std::string path = ::testing::TempDir() + "/config-" +
                           ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                           ".yaml";
  std::ofstream file(path);
  for (const std::string& line : lines) file << line << "\n";
  file.close();
  try {
    (void)ProgramConfig::load(path);
  } catch (const core::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ProgramConfig, TheShippedFileIsComplete) {
  EXPECT_EQ(load_error(lines_of_shipped_file()), "");
  EXPECT_GT(ProgramConfig::load(kFile).runtime.mpc_period, 0.0);
}

TEST(ProgramConfig, EachKeyIsNeeded) {
  const std::vector<std::string> lines = lines_of_shipped_file();
  // A line with one scalar value: taking it away must be noticed, and the key named.
  const std::regex scalar(R"(^\s+([A-Za-z_]+):\s+[^{\[#\s].*$)");
  int keys = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::smatch match;
    if (!std::regex_match(lines[i], match, scalar)) continue;
    std::vector<std::string> without = lines;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(load_error(without).find(match[1].str()), std::string::npos) << lines[i];
    ++keys;
  }
  EXPECT_GT(keys, 50);
}

TEST(ProgramConfig, AnUnknownKeyIsRefusedWithItsLine) {
  std::vector<std::string> lines = lines_of_shipped_file();
  lines.push_back("colour: red");
  const std::string error = load_error(lines);
  EXPECT_NE(error.find(":" + std::to_string(lines.size())), std::string::npos) << error;
  EXPECT_NE(error.find("colour"), std::string::npos) << error;
}

}  // namespace
}  // namespace hopscotch::apps
