#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/scenario/program.hpp"

namespace hopscotch {
namespace {

namespace fs = std::filesystem;

using apps::Answer;
using apps::call;

class CommandLine : public ::testing::Test {
 protected:
  CommandLine() : folder_(fs::temp_directory_path() / fs::path("hopscotch-" + unique_name())) {
    fs::create_directories(folder_);
  }
  ~CommandLine() override { fs::remove_all(folder_); }

  static std::string unique_name() {
    return std::string(::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  fs::path folder_;
};

TEST_F(CommandLine, HelpIsThereForEachSubcommandWithAnExample) {
  for (const char* command : {"run", "plan", "campaign", "target", "command", "report", "doctor",
                              "bench", "replay", "scene", "calibrate"}) {
    const Answer answer = call(std::string(command) + " --help");
    EXPECT_EQ(answer.status, 0) << command;
    EXPECT_NE(answer.output.find("Example:"), std::string::npos) << command;
  }
}

TEST_F(CommandLine, BadUsageIsStatusTwo) {
  EXPECT_EQ(call("").status, 2);
  EXPECT_EQ(call("fly").status, 2);
  EXPECT_EQ(call("run").status, 2);
  EXPECT_EQ(call("run x.yaml --perception eyes").status, 2);
  EXPECT_EQ(call("plan --distance far").status, 2);
  EXPECT_EQ(call("plan --distance 0.3 --video film.mp4").status, 2);  // of a flight, not of a plan
  EXPECT_EQ(call("target").status, 2);
  EXPECT_EQ(call("target 0.3 --clear").status, 2);
  EXPECT_EQ(call("target far").status, 2);
  EXPECT_EQ(call("command dance").status, 2);
}

/// The guide's own example is the first that a new user tries.
TEST_F(CommandLine, TheScenarioOfTheGuideIsCompleted) {
  std::ifstream file(fs::path(HOPSCOTCH_SOURCE_DIR) / "docs/guide.md");
  const std::string guide{std::istreambuf_iterator<char>(file), {}};
  const std::string fence = "```yaml\n";
  const std::size_t begin = guide.find(fence) + fence.size();
  const fs::path scenario =
      write("my-steps.yaml", guide.substr(begin, guide.find("```", begin) - begin));
  const Answer answer = call("run " + scenario.string() + " --seed 3 --no-pictures --out " +
                             (folder_ / "run").string());
  EXPECT_EQ(answer.status, 0) << answer.output;
  EXPECT_NE(answer.output.find("my-steps: completed"), std::string::npos) << answer.output;
}

TEST_F(CommandLine, ABrokenScenarioNamesFileLineAndRuleAndWritesNothing) {
  const fs::path scenario = write("broken.yaml",
                                  "name: broken\n"
                                  "slabs:\n"
                                  "  - {x_m: [-1.0, 2.0]}\n"
                                  "goal: {x_m: 1.0}\n"
                                  "frction: 0.5\n");
  const fs::path out = folder_ / "out";
  const Answer answer = call("run " + scenario.string() + " --out " + out.string());
  EXPECT_EQ(answer.status, 2);
  EXPECT_NE(answer.output.find("broken.yaml:5"), std::string::npos) << answer.output;
  EXPECT_NE(answer.output.find("frction"), std::string::npos);
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(CommandLine, AMissingFileIsNamed) {
  const Answer answer = call("run nowhere.yaml");
  EXPECT_EQ(answer.status, 2);
  EXPECT_NE(answer.output.find("nowhere.yaml"), std::string::npos);
}

TEST_F(CommandLine, ARunWritesAWholeFolder) {
  const fs::path scenario = write("hop.yaml",
                                  "name: hop\n"
                                  "slabs:\n"
                                  "  - {x_m: [-1.0, 3.0]}\n"
                                  "goal: {jumps: 1}\n");
  const fs::path out = folder_ / "out";
  const Answer answer = call("run " + scenario.string() + " --seed 5 --out " + out.string());
  EXPECT_EQ(answer.status, 0) << answer.output;
  for (const char* file : {"result.json", "run.lcm", "config.yaml", "report.html"}) {
    EXPECT_GT(fs::file_size(out / file), 0U) << file;
  }
  EXPECT_FALSE(fs::exists(out.string() + ".partial"));
  EXPECT_EQ(call("report " + out.string()).status, 0);
}

TEST_F(CommandLine, JsonIsAllThatStandsOnStandardOutput) {
  const Answer answer = call("plan --distance 0.3 --json 2>/dev/null");
  EXPECT_EQ(answer.status, 0);
  EXPECT_EQ(answer.output.front(), '{');
  EXPECT_NE(answer.output.find("\"hopscotch.plan/1\""), std::string::npos);
}

TEST_F(CommandLine, AnImpossiblePlanIsStatusOneWithTheReason) {
  const Answer answer = call("plan --distance 1.5");
  EXPECT_EQ(answer.status, 1);
  EXPECT_NE(answer.output.find("no plan"), std::string::npos) << answer.output;
}

TEST_F(CommandLine, UnknownRobotsAreListedAgainstTheKnownOnes) {
  const Answer answer = call("plan --distance 0.3 --robot atlas");
  EXPECT_EQ(answer.status, 2);
  EXPECT_NE(answer.output.find("hector-d14"), std::string::npos) << answer.output;
}

TEST_F(CommandLine, ReportRefusesWhatIsNoRunFolder) {
  EXPECT_EQ(call("report " + folder_.string()).status, 2);
}

/// A 16-bit PGM of a floor 0.6 m below a camera that looks down by 0.5 rad.
std::string floor_image(double unit) {
  constexpr int kWidth = 320;
  constexpr int kHeight = 240;
  std::string bytes = "P5\n320 240\n65535\n";
  for (int v = 0; v < kHeight; ++v) {
    const double down = std::sin(0.5) + (v - 120) / 192.5 * std::cos(0.5);
    const double depth = down > 0.25 ? 0.6 / down : 0.0;
    for (int u = 0; u < kWidth; ++u) {
      const int value = static_cast<int>(std::lround(depth / unit));
      bytes += static_cast<char>(value >> 8);
      bytes += static_cast<char>(value & 0xFF);
    }
  }
  return bytes;
}

TEST_F(CommandLine, SceneFindsTheFloorOfADepthImage) {
  const fs::path image = write("floor.pgm", floor_image(0.001));
  const fs::path out = folder_ / "pictures";
  const Answer answer =
      call("scene " + image.string() + " --json --out " + out.string() + " 2>/dev/null");
  EXPECT_EQ(answer.status, 0) << answer.output;
  EXPECT_NE(answer.output.find("\"schema\":\"hopscotch.terrain/1\""), std::string::npos);
  EXPECT_NE(answer.output.find("\"edges\":[]"), std::string::npos) << answer.output;
  EXPECT_EQ(answer.output.find("\"targets\":[]"), std::string::npos) << answer.output;
  for (const char* file : {"map.png", "depth.png", "terrain.json"}) {
    EXPECT_GT(fs::file_size(out / file), 100U) << file;
  }
}

TEST_F(CommandLine, SceneRefusesBadInputWithItsReason) {
  const std::string whole = floor_image(0.001);
  const std::string image = write("floor.pgm", whole).string();
  const struct {
    std::string arguments;
    const char* says;
  } kCases[] = {
      {folder_ / "nowhere.png", "is no file"},
      {write("cut.pgm", whole.substr(0, whole.size() / 2)).string(), "cut short"},
      {write("empty.pgm", "P5\n320 240\n65535\n" + std::string(2 * 320 * 240, '\0')).string(),
       "no pixel holds a reading"},
      {write("text.png", "hello").string(), "PCD"},
      {image + " --depth-scale 1", "unit"},
      {image + " --intrinsics 385,385,640,360", "do not fit"},
      {image + " --intrinsics 385,385,nan,120", "do not fit"},
      {image + " --up y --forward -y", "--forward"},
      {image + " --up w", "--up"}};
  for (const auto& tested : kCases) {
    const Answer answer = call("scene " + tested.arguments);
    EXPECT_EQ(answer.status, 2) << tested.arguments << "\n" << answer.output;
    EXPECT_NE(answer.output.find(tested.says), std::string::npos) << answer.output;
  }
}

TEST_F(CommandLine, CalibrateRefusesWhatIsNoLog) {
  const Answer answer = call("calibrate " + write("run.lcm", "no log").string());
  EXPECT_EQ(answer.status, 2);
  EXPECT_NE(answer.output.find("run.lcm"), std::string::npos) << answer.output;
  EXPECT_EQ(call("calibrate " + (folder_ / "nowhere").string()).status, 2);
}

TEST_F(CommandLine, ReplayRefusesWhatIsNoLog) {
  const fs::path text = write("run.lcm", "no log");
  EXPECT_EQ(call("replay " + text.string()).status, 2);
  EXPECT_EQ(call("replay " + (folder_ / "nowhere").string()).status, 2);
  EXPECT_EQ(call("replay " + folder_.string()).status, 2) << "a folder without images";
}

}  // namespace
}  // namespace hopscotch
