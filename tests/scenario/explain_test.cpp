#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "apps/explain.hpp"
#include "apps/run_folder.hpp"
#include "tests/scenario/program.hpp"

namespace hopscotch::apps {
namespace {

namespace fs = std::filesystem;

/// Runs with a made-up mishap, and what `explain` makes of them.
class Explain : public ::testing::Test {
 protected:
  Explain()
      : folder_(fs::path(testing::TempDir()) /
                (std::string("explain-") +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Explain() override { fs::remove_all(folder_); }

  RunFolder run(const std::string& scenario) const {
    std::ofstream(folder_ / "scenario.yaml") << scenario;
    const fs::path out = folder_ / "out";
    call("run " + (folder_ / "scenario.yaml").string() +
         " --state truth --perception truth --no-pictures --out " + out.string());
    return {out};
  }

  fs::path folder_;
};

TEST_F(Explain, AFallAfterAPushNamesThePushWithItsTime) {
  const RunFolder folder =
      run("name: pushed\n"
          "slabs:\n  - {x_m: [-1.0, 4.0]}\n"
          "goal: {jumps: 3}\n"
          "surprises:\n"
          "  - {push: {phase: flight, after_s: 0.05, duration_s: 0.1, impulse_Ns: [0.0, 40.0, "
          "0.0]}}\n");
  const Explanation explanation = explain_run(folder);
  EXPECT_EQ(explanation.result.outcome, RunOutcome::fell);
  EXPECT_EQ(explanation.first.cause, Cause::push) << to_text(explanation);
  EXPECT_EQ(explanation.first.jump, 1);
  EXPECT_GT(explanation.first.time, 0.0);
  EXPECT_LT(explanation.first.time, explanation.result.duration);

  // The black box is a run folder that tells the same.
  const Explanation boxed = explain_run({folder.black_box()});
  EXPECT_EQ(boxed.first.cause, Cause::push);

  const Answer answer = call("explain " + folder.path.string() + " --json 2>/dev/null");
  EXPECT_EQ(answer.status, 0);
  EXPECT_NE(answer.output.find("\"code\": \"push\""), std::string::npos) << answer.output;
}

TEST_F(Explain, AnIcyLandingNamesTheSlip) {
  const RunFolder folder =
      run("name: icy\n"
          "slabs:\n"
          "  - {x_m: [-1.0, 0.2]}\n"
          "  - {x_m: [0.2, 4.0], friction: 0.03}\n"
          "goal: {jumps: 2}\n");
  const Explanation explanation = explain_run(folder);
  EXPECT_NE(explanation.result.outcome, RunOutcome::completed);
  EXPECT_EQ(explanation.first.cause, Cause::slip) << to_text(explanation);
}

TEST_F(Explain, GroundThatIsNotWhereItWasSeenIsTheFirstCause) {
  const RunFolder folder =
      run("name: trapdoor\n"
          "slabs:\n"
          "  - {x_m: [-1.0, 0.25]}\n"
          "  - {x_m: [0.25, 4.0]}\n"
          "goal: {jumps: 3}\n"
          "surprises:\n"
          "  - {slab: 1, top_m: -0.40}\n");  // 35 cm are survived
  const Explanation explanation = explain_run(folder);
  EXPECT_EQ(explanation.result.outcome, RunOutcome::fell);
  EXPECT_EQ(explanation.first.cause, Cause::terrain_height) << to_text(explanation);
  EXPECT_NEAR(explanation.first.value, -0.40, 0.05);
}

TEST_F(Explain, ARefusalTellsWhyNoPlaceWouldDo) {
  const RunFolder folder =
      run("name: chasm\n"
          "slabs:\n"
          "  - {x_m: [-1.0, 0.15]}\n"
          "  - {x_m: [1.4, 3.0]}\n"
          "goal: {x_m: 1.6}\n");
  const Explanation explanation = explain_run(folder);
  EXPECT_EQ(explanation.result.outcome, RunOutcome::refused);
  EXPECT_EQ(explanation.first.cause, Cause::no_target);
  EXPECT_NE(explanation.first.sentence.find("rejected places"), std::string::npos)
      << explanation.first.sentence;
}

TEST_F(Explain, ARunThatWentWellNeedsNoExplanation) {
  const RunFolder folder =
      run("name: fine\n"
          "slabs:\n  - {x_m: [-1.0, 4.0]}\n"
          "goal: {jumps: 1}\n");
  EXPECT_EQ(explain_run(folder).first.cause, Cause::none);
  EXPECT_FALSE(fs::exists(folder.black_box()));
  EXPECT_EQ(call("explain " + folder.path.string()).status, 0);
}

TEST_F(Explain, WhatIsNoRunFolderIsNamed) {
  EXPECT_EQ(call("explain " + folder_.string()).status, 2);
  std::ofstream(folder_ / "result.json") << "{";
  std::ofstream(folder_ / "run.lcm") << "no log";
  fs::copy_file(fs::path(HOPSCOTCH_SOURCE_DIR) / "config/robots/hector.yaml",
                folder_ / "robot.yaml");
  const Answer answer = call("explain " + folder_.string());
  EXPECT_EQ(answer.status, 2) << answer.output;
  EXPECT_NE(answer.output.find("result.json"), std::string::npos) << answer.output;
}

TEST_F(Explain, ARunGoesOnWhenItsLogFindsNoRoom) {
  std::ofstream(folder_ / "scenario.yaml") << "name: full\n"
                                              "slabs:\n  - {x_m: [-1.0, 4.0]}\n"
                                              "goal: {jumps: 1}\n";
  // No file may grow beyond a quarter of a MiB, as on a disk that is full.
  const std::string line = "-c \"trap '' XFSZ; ulimit -f 256; exec " HOPSCOTCH_PROGRAM " run " +
                           (folder_ / "scenario.yaml").string() +
                           " --state truth --perception truth --no-pictures --out " +
                           (folder_ / "out").string() + "\"";
  const Answer answer = call_program("bash", line);
  EXPECT_EQ(answer.status, 0) << answer.output;
  EXPECT_NE(answer.output.find("the run goes on, its log ends at"), std::string::npos)
      << answer.output;
  EXPECT_EQ(read_run_result(folder_ / "out/result.json").outcome, RunOutcome::completed);
}

}  // namespace
}  // namespace hopscotch::apps
