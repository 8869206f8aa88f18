#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "apps/evidence.hpp"
#include "apps/explain.hpp"
#include "apps/run_folder.hpp"
#include "msgs/run_log.hpp"
#include "tests/folder_test.hpp"
#include "tests/scenario/program.hpp"
#include "tests/unit/apps/fake_run.hpp"

namespace hopscotch::apps {
namespace {

namespace fs = std::filesystem;

/// Runs with a made-up mishap, and what `explain` makes of them.
class Explain : public FolderTest {
 protected:
  RunFolder run(const std::string& scenario, const std::string& state = "truth") const {
    std::ofstream(folder_ / "scenario.yaml") << scenario;
    const fs::path out = folder_ / "out";
    call("run " + (folder_ / "scenario.yaml").string() + " --state " + state +
         " --perception truth --no-pictures --out " + out.string());
    return {out};
  }
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

struct PushCase {
  const char* name;
  const char* phase;
  double impulse;  ///< Along x [N·s].
};

class ExplainedPush : public Explain, public ::testing::WithParamInterface<PushCase> {};

TEST_P(ExplainedPush, IsFoundWholeWhereverTheRobotIs) {
  const RunFolder folder =
      run("name: pushed\n"
          "slabs:\n  - {x_m: [-1.0, 4.0]}\n"
          "goal: {jumps: 3}\n"
          "surprises:\n"
          "  - {push: {phase: " +
          std::string(GetParam().phase) + ", after_s: 0.1, duration_s: 0.1, impulse_Ns: [" +
          std::to_string(GetParam().impulse) + ", 0.0, 0.0]}}\n");
  const Explanation explanation = explain_run(folder);
  EXPECT_EQ(explanation.result.outcome, RunOutcome::fell);
  EXPECT_EQ(explanation.first.cause, Cause::push) << to_text(explanation);
  constexpr double kBlur = 3.0;  // a record every 20 ms says so much of a landing's forces [N·s]
  EXPECT_NEAR(explanation.first.value, std::abs(GetParam().impulse), kBlur) << to_text(explanation);
}

INSTANTIATE_TEST_SUITE_P(All, ExplainedPush,
                         ::testing::Values(PushCase{"takeoff_ahead", "takeoff", 14.0},
                                           PushCase{"takeoff_hard", "takeoff", 25.0},
                                           PushCase{"takeoff_back", "takeoff", -20.0},
                                           PushCase{"flight_back", "flight", -14.0},
                                           PushCase{"landing_hard", "landing", 25.0},
                                           PushCase{"landing_back", "landing", -20.0}),
                         [](const auto& test) { return test.param.name; });

struct CalmCase {
  const char* name;
  const char* scenario;
};

class ExplainedWithoutPush : public Explain, public ::testing::WithParamInterface<CalmCase> {};

TEST_P(ExplainedWithoutPush, NobodyIsBlamedForTheGroundsForces) {
  const Evidence evidence =
      collect_evidence(run(std::string("name: calm\n") + GetParam().scenario));
  ASSERT_FALSE(evidence.samples.empty());
  for (const Detector detect : detectors()) {
    const std::optional<Clue> clue = detect(evidence);
    EXPECT_FALSE(clue && clue->cause == Cause::push) << clue->sentence;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ExplainedWithoutPush,
    ::testing::Values(
        CalmCase{"leap", "slabs: [{x_m: [-1.0, 4.0]}]\ngoal: {jumps: 1}\n"},
        CalmCase{"jump_down",
                 "slabs: [{x_m: [-1.0, 0.2]}, {x_m: [0.2, 4.0], top_m: -0.25}]\n"
                 "goal: {jumps: 1}\n"},
        CalmCase{"gap", "slabs: [{x_m: [-1.0, 0.15]}, {x_m: [0.35, 4.0]}]\ngoal: {jumps: 1}\n"},
        CalmCase{"heel_on_a_hidden_step",
                 "slabs: [{x_m: [-1.0, 0.175]}, {x_m: [0.275, 0.625]}, {x_m: [0.725, 4.0]}]\n"
                 "goal: {jumps: 1}\nsurprises: [{slab: 1, top_m: 0.02}]\n"},
        CalmCase{"ground_30_cm_too_low",
                 "slabs: [{x_m: [-1.0, 0.25]}, {x_m: [0.25, 4.0]}]\ngoal: {jumps: 1}\n"
                 "surprises: [{slab: 1, top_m: -0.30}]\n"},
        CalmCase{"step_12_cm_too_high",
                 "slabs: [{x_m: [-1.0, 0.25]}, {x_m: [0.25, 4.0]}]\ngoal: {jumps: 1}\n"
                 "surprises: [{slab: 1, top_m: 0.12}]\n"},
        CalmCase{"slippery", "friction: 0.1\nslabs: [{x_m: [-1.0, 4.0]}]\ngoal: {jumps: 1}\n"},
        CalmCase{"heavy_and_weak",
                 "slabs: [{x_m: [-1.0, 4.0]}]\ngoal: {jumps: 1}\n"
                 "plant: {mass_scale: 1.3, motor_strength: 0.6}\n"}),
    [](const auto& test) { return test.param.name; });

/// Falls in the air.
std::string pushed_in_jump(int jump) {
  return "name: pushed-later\n"
         "slabs:\n  - {x_m: [-1.0, 60.0]}\n"
         "goal: {jumps: 30}\n"
         "surprises:\n"
         "  - {push: {phase: flight, occurrence: " +
         std::to_string(jump) +
         ", after_s: 0.05, duration_s: 0.1, impulse_Ns: [-14.0, 0.0, 0.0]}}\n";
}

TEST_F(Explain, ManyJumpsOfDriftAreNoCauseAndTheBlackBoxTellsTheSameTime) {
  const RunFolder folder = run(pushed_in_jump(20), "estimate");
  const Explanation explanation = explain_run(folder);
  EXPECT_EQ(explanation.first.cause, Cause::push) << to_text(explanation);
  EXPECT_EQ(explanation.first.jump, 20);
  EXPECT_GT(explanation.first.time, explanation.result.jumps.at(19).start);
  EXPECT_LT(explanation.first.time, explanation.result.duration);
  EXPECT_GT(explanation.result.duration, 20.0) << "else the black box holds it all";
  EXPECT_EQ(to_text(explain_run({folder.black_box()})), to_text(explanation));
}

/// How many of each kind stand in a log.
struct Contents {
  int scenes = 0, readings = 0, priors = 0, questions = 0, plans = 0, truths = 0;
};

Contents contents_of(const fs::path& log) {
  Contents found;
  msgs::RunLogHandlers on;
  on.scene = [&](core::Stamp, const auto&) { ++found.scenes; };
  on.sensors = [&](core::Stamp, const auto&) { ++found.readings; };
  on.prior = [&](core::Stamp, const auto&) { ++found.priors; };
  on.question = [&](core::Stamp, const auto&) { ++found.questions; };
  on.plan = [&](core::Stamp, const auto&) { ++found.plans; };
  on.truth = [&](core::Stamp, const auto&) { ++found.truths; };
  (void)msgs::read_run_log(log, on);
  return found;
}

TEST_F(Explain, TheBlackBoxOfALongRunHoldsItsLastSecondsAndThoseAreReplayed) {
  const RunFolder folder = run(pushed_in_jump(20), "estimate");
  const Contents found = contents_of(RunFolder{folder.black_box()}.log());
  EXPECT_EQ(found.scenes, 1);
  EXPECT_GT(found.readings, 19'000);
  EXPECT_GT(found.priors, 30);
  EXPECT_GT(found.questions, 15);
  EXPECT_GT(found.plans, 15);
  EXPECT_GT(found.truths, 1000);
  const Answer answer = call("replay " + RunFolder{folder.black_box()}.log().string());
  EXPECT_EQ(answer.status, 0) << answer.output;
  EXPECT_NE(answer.output.find("a black box begins in mid-run"), std::string::npos);
  EXPECT_NE(answer.output.find("0 of 0 states, 0 of 1"), std::string::npos)
      << "ten plans or more, all as recorded: " << answer.output;
}

TEST_F(Explain, TheBlackBoxOfAShortRunIsReplayedWhole) {
  const RunFolder folder = run(pushed_in_jump(1), "estimate");
  const Answer answer = call("replay " + RunFolder{folder.black_box()}.log().string());
  EXPECT_EQ(answer.status, 0) << answer.output;
  EXPECT_EQ(answer.output.find("0 of 0 states"), std::string::npos) << answer.output;
  EXPECT_NE(answer.output.find("0 of 1 plans"), std::string::npos) << answer.output;
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

struct BrokenFolder {
  const char* name;
  const char* file;     ///< That is replaced.
  const char* content;  ///< Null: removed.
  const char* says;
};

class BrokenRunFolder : public Explain, public ::testing::WithParamInterface<BrokenFolder> {};

TEST_P(BrokenRunFolder, IsBadInputThatNamesTheFile) {
  fake::write_run({folder_});
  fs::remove(folder_ / GetParam().file);
  if (GetParam().content != nullptr) {
    std::ofstream(folder_ / GetParam().file) << GetParam().content;
  }
  for (const char* command : {"explain ", "report ", "view "}) {
    const Answer answer = call(command + folder_.string());
    EXPECT_EQ(answer.status, 2) << command << answer.output;
    EXPECT_NE(answer.output.find(GetParam().file), std::string::npos) << answer.output;
    EXPECT_NE(answer.output.find(GetParam().says), std::string::npos) << answer.output;
    EXPECT_EQ(answer.output.find("json.exception"), std::string::npos) << answer.output;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BrokenRunFolder,
    ::testing::Values(
        BrokenFolder{"no_result", "result.json", nullptr, "is missing"},
        BrokenFolder{"no_log", "run.lcm", nullptr, "is missing"},
        BrokenFolder{"no_robot", "robot.yaml", nullptr, "is missing"},
        BrokenFolder{"empty_result", "result.json", "", "is empty"},
        BrokenFolder{"cut_result", "result.json", "{", "is no JSON"},
        BrokenFolder{"foreign_result", "result.json", "{\"a\": 1}", "schema is missing"},
        BrokenFolder{"other_schema", "result.json", "{\"schema\": \"hopscotch.run/2\"}",
                     "schema = \"hopscotch.run/2\", but must be hopscotch.run/1"}),
    [](const auto& test) { return test.param.name; });

TEST_F(Explain, ALogThatIsNoneIsNamed) {
  fake::write_run({folder_});
  std::ofstream(folder_ / "config.yaml") << "scenario: {}\n";
  std::ofstream(folder_ / "run.lcm") << "no log";
  const Answer answer = call("explain " + folder_.string());
  EXPECT_EQ(answer.status, 2) << answer.output;
  EXPECT_NE(answer.output.find("run.lcm: is no LCM log"), std::string::npos) << answer.output;
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
