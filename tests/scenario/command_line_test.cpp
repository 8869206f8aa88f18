#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <ostream>
#include <regex>
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
      {folder_ / "nowhere.png", "no such file"},
      {folder_.string(), "is no regular file"},
      {write("cut.pgm", whole.substr(0, whole.size() / 2)).string(), "cut short"},
      {write("empty.pgm", "P5\n320 240\n65535\n" + std::string(2 * 320 * 240, '\0')).string(),
       "no pixel holds a reading"},
      {write("text.png", "hello").string(), "is no PNG, PGM"},
      {write("empty.png", "").string(), "is no PNG, PGM"},
      {write("text.ply", "hello").string(), "PLY"},
      {write("empty.pcd", "").string(), "is no PCD"},
      {image + " --depth-scale 1", "unit"},
      {image + " --intrinsics 385,385,640,360", "do not fit"},
      {image + " --intrinsics 385,385,nan,120", "--intrinsics: nan is no finite number"},
      {image + " --up y --forward -y", "--forward"},
      {image + " --up w", "--up"}};
  for (const auto& tested : kCases) {
    const Answer answer = call("scene " + tested.arguments);
    EXPECT_EQ(answer.status, 2) << tested.arguments << "\n" << answer.output;
    EXPECT_NE(answer.output.find(tested.says), std::string::npos) << answer.output;
  }
}

struct BadOption {
  const char* arguments;
  const char* says;
};

// NOLINTNEXTLINE(readability-identifier-naming): the name that GoogleTest looks for
void PrintTo(const BadOption& bad, std::ostream* out) {
  *out << bad.arguments;
}

class BadOptionOnCommandLine : public ::testing::TestWithParam<BadOption> {};

/// Before anything is read or asked: none of the files is there, and no run is on.
TEST_P(BadOptionOnCommandLine, IsStatusTwoAndNamed) {
  const Answer answer = call(GetParam().arguments);
  EXPECT_EQ(answer.status, 2) << answer.output;
  EXPECT_NE(answer.output.find(GetParam().says), std::string::npos) << answer.output;
}

INSTANTIATE_TEST_SUITE_P(
    NoFiniteNumber, BadOptionOnCommandLine,
    ::testing::Values(BadOption{"plan --distance nan", "--distance"},
                      BadOption{"plan --distance 0.3 --friction nan", "--friction"},
                      BadOption{"plan --distance 0.3 --friction 1.3", "--friction"},
                      BadOption{"plan --distance 0.3 --edge nan", "--edge"},
                      BadOption{"plan --distance 0.3 --edge inf", "--edge"},
                      BadOption{"plan --distance 0.3 --lateral nan", "--lateral"},
                      BadOption{"plan --distance 0.3 --yaw nan", "--yaw"},
                      BadOption{"plan --distance 0.3 --height nan", "--height"},
                      BadOption{"plan --distance 0.3 --height 1e999", "--height"},
                      BadOption{"run x.yaml --pace nan", "--pace"},
                      BadOption{"target nan", "nan is no finite number"},
                      BadOption{"target 0.35 nan", "HEIGHT_M"},
                      BadOption{"target 0.3 --patience nan", "--patience"},
                      BadOption{"target 0.3 --lateral nan", "--lateral"},
                      BadOption{"target 0.3 --yaw nan", "--yaw"},
                      BadOption{"command hold --patience nan", "--patience"},
                      BadOption{"scene x.pcd --camera-height nan", "--camera-height"},
                      BadOption{"scene x.pcd --camera-pitch nan", "--camera-pitch"},
                      BadOption{"scene x.pcd --origin nan,0", "--origin"},
                      BadOption{"scene x.png --depth-scale 0", "0 is not from 1e-06 to 1\n"},
                      BadOption{"replay x --depth-scale nan", "--depth-scale"},
                      BadOption{"replay x --intrinsics 1,1,inf,1", "--intrinsics"}));

INSTANTIATE_TEST_SUITE_P(
    NoWholeNumber, BadOptionOnCommandLine,
    ::testing::Values(BadOption{"run x.yaml --seed -1", "--seed"},
                      BadOption{"run x.yaml --seed 18446744073709551616", "--seed"},
                      BadOption{"run x.yaml --seed 1.5", "--seed"},
                      BadOption{"run x.yaml --seed 010", "--seed"},
                      BadOption{"run x.yaml --jumps 0", "--jumps"},
                      BadOption{"run x.yaml --jumps 18446744073709551617", "--jumps"},
                      BadOption{"run x.yaml --port 65536", "--port"},
                      BadOption{"view x --port -1", "--port"},
                      BadOption{"plan --distance 0.3 --repeat 0", "--repeat"},
                      BadOption{"campaign x.yaml --out x --jobs 0x4", "--jobs"},
                      BadOption{"campaign x.yaml --out x --trial -1", "--trial"},
                      BadOption{"bench planner --fly 2 --seed -1", "--seed"},
                      BadOption{"bench planner --fly 0", "--fly"},
                      BadOption{"bench estimator --jumps -3", "--jumps"}));

INSTANTIATE_TEST_SUITE_P(
    OptionOfSomethingElse, BadOptionOnCommandLine,
    ::testing::Values(BadOption{"bench planner --compare --fly 2", "--compare"},
                      BadOption{"bench planner --seed 3", "--fly"},
                      BadOption{"bench planner --jumps 3", "option of `bench estimator`"},
                      BadOption{"bench planner --fly 2 --targets 9", "--targets"},
                      BadOption{"bench tick --qps x", "option of `bench mpc`"},
                      BadOption{"bench mpc --fly 2", "option of `bench planner`"},
                      BadOption{"bench sim --compare", "option of `bench planner`"},
                      BadOption{"plan --distance 0.4 --model srbd --solver chain", "ipopt"},
                      BadOption{"plan --distance 0.4 --model srbd --yaw 0.1", "--yaw"},
                      BadOption{"target --clear --yaw 0.1", "--clear"}));

INSTANTIATE_TEST_SUITE_P(
    NoUsableFile, BadOptionOnCommandLine,
    ::testing::Values(BadOption{"run /dev/null", "/dev/null: is no regular file"},
                      BadOption{"run .", ".: is no regular file"},
                      BadOption{"plan --distance 0.3 --config /dev/null", "is no regular file"},
                      BadOption{"campaign /dev/null --out x", "is no regular file"},
                      BadOption{"bench mpc --qps nowhere", "nowhere: no such file"}));

TEST_F(CommandLine, EmptyFilesAreBadInput) {
  const std::string empty = write("empty.yaml", "").string();
  for (const char* command : {"run ", "campaign --out nowhere ", "bench mpc --qps "}) {
    const std::string line = command + empty;
    const Answer answer = call(line);
    EXPECT_EQ(answer.status, 2) << line;
    EXPECT_NE(answer.output.find("empty.yaml"), std::string::npos) << answer.output;
  }
}

TEST_F(CommandLine, ANameThatLeadsOutOfTheFolderOfRunsIsRefused) {
  const fs::path scenario =
      write("evil.yaml", "slabs: [{x_m: [-1.0, 3.0]}]\nname: ../../evil\ngoal: {jumps: 1}\n");
  const Answer answer = call("run " + scenario.string());
  EXPECT_EQ(answer.status, 2);
  EXPECT_NE(answer.output.find("evil.yaml:2: name = ../../evil"), std::string::npos)
      << answer.output;
}

TEST_F(CommandLine, APlanThatBreaksALimitSaysSo) {
  const Answer text = call("plan --distance 0.4 --model srbd");
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.output.find("the certificate does not hold: knee speed has margin -0."),
            std::string::npos)
      << text.output;
  EXPECT_NE(
      call("plan --distance 0.4 --model srbd --json").output.find("\"certificate_holds\": false"),
      std::string::npos);
  EXPECT_EQ(call("plan --distance 0.4").output.find("certificate"), std::string::npos);
  EXPECT_NE(call("plan --distance 0.4 --json").output.find("\"certificate_holds\": true"),
            std::string::npos);
}

TEST_F(CommandLine, DoctorNamesTheLibrariesWithTheirVersions) {
  const auto findings = nlohmann::json::parse(call("doctor --json").output).at("checks");
  for (const char* library :
       {"MuJoCo", "Ipopt", "PCL", "OctoMap", "OpenCV", "Ceres", "LCM", "Eigen"}) {
    const auto found = std::find_if(findings.begin(), findings.end(), [&](const auto& finding) {
      return finding.at("name") == library;
    });
    ASSERT_NE(found, findings.end()) << library;
    EXPECT_TRUE(found->at("ok").template get<bool>()) << *found;
    const auto version = found->at("found").template get<std::string>();
    EXPECT_TRUE(std::regex_search(version, std::regex("[0-9]+\\.[0-9]+"))) << version;
  }
}

TEST_F(CommandLine, AFallenJumpHasNoLandingPlace) {
  const fs::path scenario = write("pushed.yaml",
                                  "name: pushed\n"
                                  "slabs: [{x_m: [-1.0, 3.0]}]\n"
                                  "goal: {jumps: 1}\n"
                                  "surprises: [{push: {phase: flight, impulse_Ns: [60, 0, 0]}}]\n");
  const Answer answer =
      call("run " + scenario.string() + " --perception truth --no-pictures --out " +
           (folder_ / "run").string());
  EXPECT_EQ(answer.status, 1) << answer.output;
  EXPECT_NE(answer.output.find("-> fell"), std::string::npos) << answer.output;
  EXPECT_EQ(answer.output.find("nan"), std::string::npos) << answer.output;
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
