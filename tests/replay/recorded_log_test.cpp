#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "apps/installation.hpp"
#include "apps/lockstep_run.hpp"
#include "apps/replay.hpp"
#include "apps/run_recorder.hpp"
#include "core/config_reader.hpp"

/// A run is recorded once, with a small camera, and looked at again.
namespace hopscotch::apps {
namespace {

namespace fs = std::filesystem;

/// The second jump leaves a slope: its plan is made with less friction.
constexpr const char* kScenario =
    "name: replayed\n"
    "camera: {width: 320, height: 240}\n"
    "slabs:\n"
    "  - {x_m: [-1.0, 0.175]}\n"
    "  - {x_m: [0.275, 0.625], top_m: 0.05, slope_rad: 0.1}\n"
    "  - {x_m: [0.725, 3.0], top_m: 0.09}\n"
    "goal: {jumps: 2}\n";

ProgramConfig tuning() {
  return ProgramConfig::load(config_directory() / "hopscotch.yaml");
}

model::RobotParameters hector() {
  return model::RobotParameters::load(robot_file("hector"));
}

class RecordedLog : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    // ctest runs each test in a process of its own, side by side.
    folder() = fs::path(::testing::TempDir()) / ("recorded_log_test-" + std::to_string(getpid()));
    fs::remove_all(folder());
    RunRequest request;
    request.scenario = sim::Scenario::from_text(kScenario, "replayed");
    request.config = tuning();
    request.robot = hector();
    request.plant_robot = hector();
    request.log_depth = true;
    RunRecorder recorder(folder(), 7, request, {kScenario, "", ""});
    LockstepRun run(request);
    while (run.step([&](const TickRecord& tick) { recorder.record(tick); })) {
    }
    (void)recorder.finish(run.result());
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }

  static fs::path& folder() {
    static fs::path path;
    return path;
  }
  static fs::path log() { return folder() / "run.lcm"; }

  static std::vector<std::string> lines_of_replay() {
    std::vector<std::string> lines;
    (void)replay_log(log(), tuning(), hector(),
                     [&](const ReplayedLook& look) { lines.push_back(terrain_json(look.report)); });
    return lines;
  }
};

TEST(DroppedRobot, SeesWhereToJumpAndIsReplayedAlike) {
  const std::string scenario =
      "name: dropped\ncamera: {width: 320, height: 240}\nslabs: [{x_m: [-1.0, 3.0]}]\n"
      "start: {drop_m: 0.2}\ngoal: {jumps: 1}\n";
  const fs::path folder =
      fs::path(::testing::TempDir()) / ("dropped_robot_test-" + std::to_string(getpid()));
  RunRequest request;
  request.scenario = sim::Scenario::from_text(scenario, "dropped");
  request.config = tuning();
  request.robot = hector();
  request.plant_robot = hector();
  request.log_depth = true;
  RunRecorder recorder(folder, 9, request, {scenario, "", ""});
  LockstepRun run(request);
  while (run.step([&](const TickRecord& tick) { recorder.record(tick); })) {
  }
  (void)recorder.finish(run.result());
  EXPECT_EQ(run.result().outcome, RunOutcome::completed) << run.result().reason;
  const ReplaySummary summary = replay_log(folder / "run.lcm", tuning(), hector(), {});
  EXPECT_GE(summary.looks, 1);
  EXPECT_EQ(summary.terrains_differing + summary.targets_differing, 0);
  fs::remove_all(folder);
}

TEST_F(RecordedLog, LooksTheSameAgainBitByBit) {
  int compared = 0;
  const ReplaySummary summary =
      replay_log(log(), tuning(), hector(), [&](const ReplayedLook& look) {
        compared += look.terrain_equal.has_value() && look.target_equal.has_value() ? 1 : 0;
      });
  EXPECT_GE(summary.looks, 2);
  EXPECT_EQ(compared, summary.looks);
  EXPECT_GT(summary.frames, 40);
  EXPECT_EQ(summary.terrains_differing, 0);
  EXPECT_EQ(summary.targets_differing, 0);
}

TEST_F(RecordedLog, EstimatorAndPlannerDoTheSameAgainBitByBit) {
  const ReplaySummary summary = replay_log(log(), tuning(), hector(), {});
  EXPECT_GT(summary.states.compared, 100);
  EXPECT_EQ(summary.states.differing, 0);
  EXPECT_GE(summary.plans.compared, 2);
  EXPECT_EQ(summary.plans.differing, 0);
}

TEST_F(RecordedLog, AnotherEstimatorAndAnotherPlannerAreNoticed) {
  ProgramConfig config = tuning();
  config.control.estimator.filter.encoder_sigma *= 1.5;
  config.planner.clearance += 0.005;
  const ReplaySummary summary = replay_log(log(), config, hector(), {});
  EXPECT_GT(summary.states.differing, 100);
  EXPECT_EQ(summary.plans.differing, summary.plans.compared);
}

TEST_F(RecordedLog, SameLogGivesTheSameBytes) {
  const std::vector<std::string> first = lines_of_replay();
  ASSERT_FALSE(first.empty());
  EXPECT_EQ(first, lines_of_replay());
}

TEST_F(RecordedLog, OtherTuningIsNoticed) {
  ProgramConfig config = tuning();
  config.footstep.preference.nominal_distance = 0.30;
  const ReplaySummary summary = replay_log(log(), config, hector(), {});
  EXPECT_EQ(summary.terrains_differing, 0);
  EXPECT_GT(summary.targets_differing, 0);
}

TEST_F(RecordedLog, CutOrDamagedOrForeignLogsAreErrors) {
  std::ostringstream content;
  content << std::ifstream(log(), std::ios::binary).rdbuf();
  const std::string whole = content.str();
  const auto message_of = [&](const std::string& bytes) -> std::string {
    const fs::path file = folder() / "damaged.lcm";
    std::ofstream(file, std::ios::binary) << bytes;
    try {
      (void)replay_log(file, tuning(), hector(), {});
    } catch (const core::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message_of(whole.substr(0, whole.size() - 100)).find("cut short"), std::string::npos);
  EXPECT_NE(message_of("no log at all").find("no LCM log"), std::string::npos);
  EXPECT_NE(message_of(""), "");
  std::string damaged = whole;
  damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] ^ 0x55);
  (void)message_of(damaged);  // whatever it hits: no crash
  EXPECT_THROW((void)replay_log("nowhere.lcm", tuning(), hector(), {}), core::ConfigError);
}

}  // namespace
}  // namespace hopscotch::apps
