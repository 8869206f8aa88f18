#include <gtest/gtest.h>

#include "apps/campaign/store.hpp"
#include "tests/scenario/campaign_folder.hpp"

namespace hopscotch::tests {
namespace {

using apps::campaign::Store;

class Campaign : public ::testing::Test {
 protected:
  Campaign() : folder_(::testing::UnitTest::GetInstance()->current_test_info()->name()) {}

  std::vector<std::string> words(const fs::path& spec, const std::string& out,
                                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> result{HOPSCOTCH_PROGRAM, "campaign", spec.string(), "--out",
                                    (folder_.path() / out).string()};
    result.insert(result.end(), more.begin(), more.end());
    return result;
  }
  int run(const fs::path& spec, const std::string& out, const std::vector<std::string>& more = {}) {
    return Process(words(spec, out, more), log()).wait();
  }
  [[nodiscard]] fs::path log() const { return folder_.path() / "log"; }
  [[nodiscard]] std::string table(const std::string& out) const {
    return text_of(folder_.path() / out / "trials.csv");
  }
  /// Rows in the store of a campaign that may be running.
  [[nodiscard]] std::int64_t rows(const std::string& out) const {
    const fs::path file = folder_.path() / out / "trials.sqlite";
    std::int64_t count = 0;
    try {
      Store(file).for_each(Store::Paths::without, [&](const auto&) { ++count; });
    } catch (const std::exception&) {  // not begun yet
    }
    return count;
  }

  TestFolder folder_;
};

TEST_F(Campaign, KilledWorkersAndParentEndWithTheStoreOfAnUndisturbedRun) {
  const fs::path spec = folder_.write("short.yaml", short_campaign(5));
  ASSERT_EQ(run(spec, "undisturbed", {"--jobs", "1"}), 0) << text_of(log());
  {
    Process campaign(words(spec, "killed", {"--jobs", "2"}), log());
    ASSERT_TRUE(eventually([&] { return !campaign.children().empty(); }));
    kill(campaign.children().front(), SIGKILL);
    ASSERT_TRUE(eventually([&] { return rows("killed") >= 3; }));
    const std::vector<pid_t> workers = campaign.children();
    campaign.send(SIGKILL);
    EXPECT_EQ(campaign.wait(), 128 + SIGKILL);
    for (const pid_t worker : workers) {
      EXPECT_TRUE(eventually([&] { return kill(worker, 0) != 0; })) << "a worker lives on";
    }
  }
  EXPECT_LT(rows("killed"), 10);
  EXPECT_EQ(run(spec, "killed"), 2) << "must not start anew without being told";
  ASSERT_EQ(run(spec, "killed", {"--resume", "--jobs", "2"}), 0) << text_of(log());
  EXPECT_EQ(rows("killed"), 10);
  EXPECT_EQ(table("killed"), table("undisturbed"));
}

TEST_F(Campaign, ComparesThePitchErrorOfItsCellsAndTimesItsJumps) {
  const fs::path spec = folder_.write("pair.yaml",
                                      "name: pair\n"
                                      "scenario: {family: flat, jumps: 2, jump_m: 0.40}\n"
                                      "perception: truth\nstate: truth\ntrials: 1\n"
                                      "keep: {failures: 0, successes: 0}\n"
                                      "vary: {ablation: {grid: [none, no-landing-plan]}}\n");
  ASSERT_EQ(run(spec, "out"), 0) << text_of(log());
  const std::string figure = text_of(folder_.path() / "out/figures/pitch-error.svg");
  EXPECT_NE(figure.find("ablation = no-landing-plan"), std::string::npos) << figure;
  EXPECT_NE(figure.find("class=\"median\""), std::string::npos) << figure;
  const Store store(folder_.path() / "out/trials.sqlite");
  const apps::campaign::TrialResult whole = store.find(0).value();
  const apps::campaign::TrialResult less = store.find(1).value();
  EXPECT_LT(whole.pitch_error, less.pitch_error);
  EXPECT_GT(whole.jump_time, 1.0);
  EXPECT_LE(whole.jump_time, 1.2);
}

TEST_F(Campaign, CtrlCSavesAndSaysHowToGoOn) {
  const fs::path spec = folder_.write("short.yaml", short_campaign(50));
  Process campaign(words(spec, "out", {"--jobs", "1"}), log());
  ASSERT_TRUE(eventually([&] { return rows("out") >= 1; }));
  campaign.send(SIGINT);
  EXPECT_EQ(campaign.wait(), 1);
  EXPECT_NE(text_of(log()).find("--resume"), std::string::npos) << text_of(log());
  EXPECT_GE(rows("out"), 1);
  Process again(words(spec, "out", {"--jobs", "1", "--resume"}), log());
  ASSERT_TRUE(eventually([&] { return !again.children().empty(); }));
  again.send(SIGINT);
  again.send(SIGTERM);
  EXPECT_EQ(again.wait(), 1);
}

TEST_F(Campaign, AHangIsBoundedAndMarked) {
  const fs::path spec = folder_.write("short.yaml", short_campaign(1, "trial_timeout_s: 0.01\n"));
  ASSERT_EQ(run(spec, "out"), 0) << text_of(log());
  EXPECT_NE(table("out").find("hung,,trial_hung"), std::string::npos) << table("out");
}

TEST_F(Campaign, ATrialIsRunAgainAloneWithItsLog) {
  const fs::path spec = folder_.write("short.yaml", short_campaign(2));
  ASSERT_EQ(run(spec, "out", {"--trial", "3"}), 0) << text_of(log());
  EXPECT_GT(fs::file_size(folder_.path() / "out/runs/trial-3/run.lcm"), 1000U);
  EXPECT_EQ(run(spec, "out", {"--trial", "4"}), 2);
}

TEST_F(Campaign, BadInputIsStatusTwoAndWritesNothing) {
  EXPECT_EQ(run("nowhere.yaml", "out"), 2);
  const fs::path unknown =
      folder_.write("unknown.yaml",
                    "name: a\nscenario: {family: flat}\ntrials: 1\nstate: truth\n"
                    "vary: {gravity: [9, 10]}\n");
  EXPECT_EQ(run(unknown, "out"), 2);
  EXPECT_NE(text_of(log()).find("unknown.yaml:5"), std::string::npos) << text_of(log());
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
}

}  // namespace
}  // namespace hopscotch::tests
