#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <optional>
#include <sstream>
#include <string>

#include "apps/command_gate.hpp"
#include "apps/live_run.hpp"
#include "apps/operator_client.hpp"
#include "apps/run_result.hpp"
#include "tests/folder_test.hpp"
#include "tests/scenario/own_network.hpp"
#include "tests/scenario/program.hpp"

namespace hopscotch::apps {
namespace {

namespace fs = std::filesystem;
using core::Reason;

/// A run in real time on level ground, and an operator who talks to it.
class OperatorOfARun : public FolderTest {
 protected:
  static void SetUpTestSuite() { use_own_network(); }
  OperatorOfARun() {
    std::ofstream(folder_ / "plain.yaml") << "name: plain\n"
                                             "slabs:\n"
                                             "  - {x_m: [-1.0, 60.0]}\n"
                                             "goal: {x_m: 50.0}\n";
  }
  ~OperatorOfARun() override {
    if (run_.valid()) call("command stop");
    if (run_.valid()) run_.wait();
  }

  void start_run() {
    const std::string line = "run " + (folder_ / "plain.yaml").string() +
                             " --state truth --perception truth --pace 1 --no-pictures --out " +
                             out().string();
    run_ = std::async(std::launch::async, [line] { return call(line); });
    client_.emplace(live_url());
    const auto runs = client_->running(30.0);
    ASSERT_EQ(runs.size(), 1U);
    EXPECT_TRUE(runs[0].is_alone);
    id_ = runs[0].id;
  }
  fs::path out() const { return folder_ / "out"; }

  core::OperatorCommand command_now() const {
    core::OperatorCommand command;
    command.run_id = id_;
    command.sequence = wall_clock_us();
    return command;
  }
  Reason ask(const core::OperatorCommand& command) {
    const std::optional<msgs::Ack> ack = client_->ask(command, 20.0);
    return ack ? ack->refusal.reason : Reason::internal_error;
  }

  std::future<Answer> run_;
  std::optional<OperatorClient> client_;
  std::uint64_t id_ = 0;
};

TEST_F(OperatorOfARun, HearsThatNobodyAnswersWhenNothingIsOn) {
  const Answer answer = call("target 0.35");
  EXPECT_EQ(answer.status, 1);
  EXPECT_NE(answer.output.find("nobody answered"), std::string::npos) << answer.output;
  EXPECT_EQ(call("command hold --run ff").status, 1);
}

TEST_F(OperatorOfARun, SteersIt) {
  start_run();
  const Answer accepted = call("target 0.30 0.0 --patience 60");
  EXPECT_EQ(accepted.status, 0) << accepted.output;
  EXPECT_NE(accepted.output.find("accepted"), std::string::npos) << accepted.output;

  const Answer refused = call("target 2.5 --patience 60");
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.output.find("refused: out_of_reach"), std::string::npos) << refused.output;

  EXPECT_EQ(call("command hold").status, 0);
  const Answer promised = call("target 0.28 --patience 60 --json 2>/dev/null");
  EXPECT_EQ(promised.status, 0) << promised.output;
  EXPECT_NE(promised.output.find("\"accepted\":true"), std::string::npos) << promised.output;
  EXPECT_NE(promised.output.find("held"), std::string::npos) << promised.output;
  EXPECT_EQ(call("target --clear").status, 0);
  EXPECT_EQ(call("command clear-fault").status, 1) << "there is none";
  EXPECT_EQ(call("command stop").status, 0);

  const Answer run = run_.get();
  EXPECT_EQ(run.status, 0) << run.output;
  const RunResult result = read_run_result(out() / "result.json");
  EXPECT_EQ(result.outcome, RunOutcome::stopped);
  int by_operator = 0;
  for (const JumpResult& jump : result.jumps) {
    if (jump.target.source != core::TargetSource::operator_override) continue;
    ++by_operator;
    EXPECT_NEAR(jump.target.distance, 0.30, 1e-6);
  }
  EXPECT_EQ(by_operator, 1) << "the cleared one is not flown";
}

TEST_F(OperatorOfARun, CannotRepeatForgeOrMisdirectCommands) {
  start_run();
  core::OperatorCommand hold = command_now();
  hold.mode = core::ModeRequest::hold;
  EXPECT_EQ(ask(hold), Reason::none);
  EXPECT_EQ(ask(hold), Reason::repeated_command);

  core::OperatorCommand old = command_now();
  old.mode = core::ModeRequest::jump;
  old.sequence -= 3'600'000'000U;  // an hour: somebody's recording
  EXPECT_EQ(ask(old), Reason::stale_command);

  core::OperatorCommand foreign = command_now();
  foreign.mode = core::ModeRequest::jump;
  foreign.run_id = id_ + 1;
  EXPECT_FALSE(client_->ask(foreign, 1.0)) << "the other run is not on";

  core::OperatorCommand malformed = command_now();
  malformed.target = core::TargetOverride{.distance = core::kNaN};
  EXPECT_EQ(ask(malformed), Reason::target_malformed);
}

}  // namespace
}  // namespace hopscotch::apps
