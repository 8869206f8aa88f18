#include "apps/run_result.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/config_reader.hpp"
#include "tests/unit/apps/fake_run.hpp"

namespace hopscotch::apps {
namespace {

TEST(RunResult, SurvivesTheFileUnchanged) {
  const RunResult written = fake::result();
  const std::string text = to_json(written);
  const RunResult read = run_result_from_json(text, "result.json");
  EXPECT_EQ(to_json(read), text);
  EXPECT_EQ(read.scenario, written.scenario);
  EXPECT_EQ(read.seed, written.seed);
  EXPECT_EQ(read.outcome, written.outcome);
  ASSERT_EQ(read.jumps.size(), 2U);
  EXPECT_EQ(read.jumps[1].index, 2);
  EXPECT_EQ(read.jumps[1].outcome, JumpOutcome::landed);
  EXPECT_DOUBLE_EQ(read.jumps[1].landing.distance, 0.395);
  EXPECT_EQ(read.jumps[1].plan.binding_name, "knee power");
  EXPECT_TRUE(read.jumps[1].plan.warm);
  EXPECT_EQ(read.jumps[1].plan.replanned, written.jumps[1].plan.replanned);
  EXPECT_DOUBLE_EQ(read.timing.plan_ms.p99, 260.0);
}

TEST(RunResult, KeysStandInTheOrderOfTheContract) {
  const std::string text = to_json(fake::result());
  std::size_t from = 0;
  for (const char* key :
       {"schema",          "run_id",        "scenario",     "seed",          "program",
        "perception",      "state",         "outcome",      "reason",        "duration_s",
        "jumps",           "index",         "target",       "distance_m",    "height_m",
        "source",          "landing",       "toe_margin_m", "heel_margin_m", "plan",
        "status",          "iterations",    "warm",         "duration_s",    "binding",
        "margin",          "takeoff",       "speed_x_mps",  "speed_z_mps",   "estimate_error_mps",
        "flight_s",        "peak",          "torque_ratio", "speed_ratio",   "power_ratio",
        "normal_force_N",  "falls",         "state_error",  "position_m",    "pitch_rad",
        "timing",          "plan_ms",       "p50",          "p99",           "max",
        "mpc_ms",          "perception_ms", "estimator_ms", "tick_ms",       "deadline_misses",
        "real_time_factor"}) {
    const std::size_t found = text.find(std::string(1, '"').append(key).append("\":"), from);
    ASSERT_NE(found, std::string::npos) << key << " is missing or out of order";
    from = found;
  }
}

TEST(RunResult, UnknownNumbersAreNullAndComeBackAsNaN) {
  RunResult result = fake::result();
  result.jumps[0].landing.toe_margin = core::kNaN;
  const std::string text = to_json(result);
  EXPECT_NE(text.find("\"toe_margin_m\": null"), std::string::npos);
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_TRUE(std::isnan(run_result_from_json(text, "x").jumps[0].landing.toe_margin));
}

TEST(RunResult, NumbersAreRoundedToWhatMatters) {
  RunResult result = fake::result();
  result.duration = 9.8000000001;
  result.position_error = -1e-9;
  const std::string text = to_json(result);
  EXPECT_NE(text.find("\"duration_s\": 9.8,"), std::string::npos);
  EXPECT_NE(text.find("\"position_m\": 0.0,"), std::string::npos);
}

TEST(RunResult, TextThatIsNoUnicodeStillGivesAFile) {
  RunResult result = fake::result();
  result.scenario = "bad \xFF byte";
  EXPECT_NE(to_json(result).find("bad "), std::string::npos);
}

struct Broken {
  const char* name;
  const char* from;
  const char* to;
  const char* message;
};
class BrokenRunResult : public testing::TestWithParam<Broken> {};

TEST_P(BrokenRunResult, IsRefusedByNameAndReason) {
  std::string text = to_json(fake::result());
  const std::size_t at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(GetParam().from).size(), GetParam().to);
  try {
    (void)run_result_from_json(text, "some/result.json");
    FAIL() << "accepted";
  } catch (const core::ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).find("json.exception"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("some/result.json"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos)
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BrokenRunResult,
    testing::Values(Broken{"schema", "hopscotch.run/1", "hopscotch.run/9", "hopscotch.run/9"},
                    Broken{"outcome", "\"completed\"", "\"won\"", "\"won\""},
                    Broken{"missing", "\"falls\"", "\"fails\"", ": falls is missing"},
                    Broken{"type", "\"seed\": 7", "\"seed\": \"7\"",
                           "seed = \"7\", but must be a whole number from 0 on"},
                    Broken{"negative", "\"index\": 1", "\"index\": -1", "jumps[0].index = -1, but"},
                    Broken{"object", "\"timing\": {", "\"timing\": 3, \"was\": {",
                           "timing = 3, but must be an object"},
                    Broken{"list", "\"jumps\": [", "\"jumps\": [5, ", "must be a list of objects"},
                    Broken{"number", "\"toe_margin_m\": 0.06", "\"toe_margin_m\": true",
                           "jumps[0].landing.toe_margin_m = true, but must be a number or null"},
                    Broken{"syntax", "{", "{{", "result.json:1: is no JSON"}),
    [](const auto& broken) { return broken.param.name; });

TEST(RunResult, NothingAndForeignJsonAreNamed) {
  const auto complaint = [](const char* text) -> std::string {
    try {
      (void)run_result_from_json(text, "r.json");
    } catch (const core::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(""), "r.json:1: is empty");
  EXPECT_EQ(complaint("{\n\"a\": 1,\n"), "r.json:3: is no JSON, or is cut short");
  EXPECT_EQ(complaint("[1]"), "r.json: must be a JSON object");
  EXPECT_EQ(complaint("{}"), "r.json: schema is missing");
}

TEST(RunResult, FileIsWholeOrNotThere) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "run_result_file";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  write_run_result(folder / "result.json", fake::result());
  EXPECT_EQ(to_json(read_run_result(folder / "result.json")), to_json(fake::result()));
  EXPECT_FALSE(std::filesystem::exists(folder / "result.json.part"));
  EXPECT_THROW(write_run_result(folder / "missing" / "result.json", {}), std::runtime_error);
  EXPECT_THROW((void)read_run_result(folder / "none.json"), std::runtime_error);
  std::filesystem::remove_all(folder);
}

TEST(Percentiles, AreByNearestRank) {
  std::vector<double> samples;
  for (int i = 100; i >= 1; --i) samples.push_back(i);
  const Percentiles percentiles = Percentiles::of(samples);
  EXPECT_EQ(percentiles.p50, 50.0);
  EXPECT_EQ(percentiles.p99, 99.0);
  EXPECT_EQ(percentiles.max, 100.0);
  EXPECT_EQ(Percentiles::of({3.0}).p50, 3.0);
  EXPECT_TRUE(std::isnan(Percentiles::of({}).max));
}

TEST(JumpTimes, LastFromTheStartOfALandedJumpToTheNext) {
  std::vector<JumpResult> jumps(22);
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    jumps[i].start = 1.2 * static_cast<double>(i);
    jumps[i].outcome = JumpOutcome::landed;
  }
  jumps[5].outcome = JumpOutcome::aborted;                      // its time says nothing
  for (std::size_t i = 11; i < 22; ++i) jumps[i].start += 0.2;  // the tenth took longer
  for (std::size_t i = 21; i < 22; ++i) jumps[i].start += 0.1;  // and so did the last but one
  const JumpTimes times = jump_times(jumps);
  EXPECT_EQ(times.count, 20);
  EXPECT_NEAR(times.mean, 1.2 + 0.3 / 20.0, 1e-12);
  EXPECT_NEAR(times.p95, 1.3, 1e-12);
}

TEST(JumpTimes, AreUnknownOfASingleJump) {
  EXPECT_TRUE(std::isnan(jump_times(std::vector<JumpResult>(1)).mean));
  EXPECT_TRUE(std::isnan(jump_times({}).p95));
}

TEST(RunResult, FoldersOfOlderProgramsAreRead) {
  std::string text = to_json(fake::result());
  for (const char* key : {"\"start_s\"", "\"pitch_error_rad\""}) {
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key)) {
      text.replace(at, std::string(key).size(), "\"x\"");
    }
  }
  const RunResult read = run_result_from_json(text, "old");
  EXPECT_TRUE(std::isnan(read.jumps.at(0).start));
  EXPECT_TRUE(std::isnan(read.jumps.at(0).landing.pitch_error));
}

}  // namespace
}  // namespace hopscotch::apps
