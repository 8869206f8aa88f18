#include "apps/campaign/store.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "apps/campaign/analysis.hpp"
#include "apps/campaign/campaign.hpp"
#include "apps/campaign/campaign_report.hpp"
#include "apps/campaign/comparison.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps::campaign {
namespace {

namespace fs = std::filesystem;

TrialResult result_of(std::int64_t index, const std::string& outcome) {
  TrialResult result;
  result.index = index;
  result.seed = 1234567890123ULL + static_cast<std::uint64_t>(index);
  result.outcome = outcome;
  if (outcome == "fell") {
    result.cause = "fell_in_landing";
    result.sentence = "the trunk touches \"slab.1\"";
  }
  result.jumps = 2;
  result.landed = outcome == "completed" ? 2 : 1;
  result.duration = 3.25;
  result.support_margin = 0.01 * static_cast<double>(index % 7);
  result.values = {0.5 + 0.01 * static_cast<double>(index % 10), core::kNaN};
  result.wall = 0.3;
  result.path = {{{0, 390}}, {{-5, 391}}, {{400, 550}}};
  return result;
}

class StoreTest : public ::testing::Test {
 protected:
  StoreTest()
      : folder_(fs::temp_directory_path() /
                ("hopscotch-store-" + std::to_string(getpid()) + "-" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
    Factor friction{.name = "friction",
                    .kind = Factor::Kind::uniform,
                    .lowest = 0.4,
                    .highest = 0.8,
                    .values = {},
                    .labels = {}};
    Factor phase{.name = "push.phase",
                 .kind = Factor::Kind::grid,
                 .values = {0.0, 1.0},
                 .labels = {"takeoff", "flight"},
                 .words = true};
    identity_ = {.identity = "id",
                 .program = "1.0",
                 .pairing = "pair",
                 .name = "test",
                 .source = "name: test\n",
                 .cells = 2,
                 .factors = {friction, phase}};
  }
  ~StoreTest() override { fs::remove_all(folder_); }

  fs::path folder_;
  StoreIdentity identity_;
};

TEST_F(StoreTest, RowsComeBackAsTheyWere) {
  {
    Store store(folder_ / "a.sqlite", identity_);
    EXPECT_TRUE(store.add(result_of(3, "fell")));
  }
  const Store again(folder_ / "a.sqlite");
  const TrialResult row = again.find(3).value();
  EXPECT_EQ(to_line(row), to_line(result_of(3, "fell")));
  EXPECT_FALSE(again.find(4).has_value());
  EXPECT_EQ(again.identity().factors.at(1).labels.at(1), "flight");
}

TEST_F(StoreTest, ATrialHasOneRowWhoeverDeliversIt) {
  Store store(folder_ / "a.sqlite", identity_);
  EXPECT_TRUE(store.add(result_of(1, "completed")));
  EXPECT_FALSE(store.add(result_of(1, "fell")));
  EXPECT_EQ(store.find(1).value().outcome, "completed");
}

TEST_F(StoreTest, OtherCampaignsAndProgramsAreRefused) {
  { Store store(folder_ / "a.sqlite", identity_); }
  StoreIdentity other = identity_;
  other.identity = "something else";
  EXPECT_THROW(Store(folder_ / "a.sqlite", other), core::ConfigError);
  other = identity_;
  other.program = "1.1";
  EXPECT_THROW(Store(folder_ / "a.sqlite", other), core::ConfigError);
  std::ofstream(folder_ / "text.sqlite") << "this is no database, whatever its name says";
  EXPECT_ANY_THROW(Store(folder_ / "text.sqlite", identity_));
}

TEST_F(StoreTest, MergingAddsWhatIsNewAndRefusesStrangers) {
  Store into(folder_ / "a.sqlite", identity_);
  into.add(result_of(0, "completed"));
  {
    Store from(folder_ / "b.sqlite", identity_);
    from.add(result_of(0, "completed"));
    from.add(result_of(1, "fell"));
    StoreIdentity other = identity_;
    other.program = "1.1";
    Store stranger(folder_ / "c.sqlite", other);
  }
  EXPECT_EQ(merge(folder_ / "b.sqlite", into), 1);
  EXPECT_EQ(into.find(1).value().outcome, "fell");
  EXPECT_THROW(merge(folder_ / "c.sqlite", into), core::ConfigError);
}

/// Writes rows until the file may grow no more; exit status 0 if that was told as an error.
int fill_up(const fs::path& file, const StoreIdentity& identity) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{400'000, 400'000};
  setrlimit(RLIMIT_FSIZE, &limit);
  try {
    Store store(file, identity);
    for (std::int64_t i = 0; i < 100'000; ++i) store.add(result_of(i, "completed"));
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 1;
}

TEST_F(StoreTest, AFullDiskIsAnErrorAndKeepsWhatWasStored) {
  const pid_t child = fork();  // the limit is for the process
  ASSERT_GE(child, 0);
  if (child == 0) _exit(fill_up(folder_ / "a.sqlite", identity_));
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  Store store(folder_ / "a.sqlite", identity_);
  std::int64_t rows = 0;
  store.for_each(Store::Paths::with, [&](const TrialResult& row) { EXPECT_EQ(row.index, rows++); });
  EXPECT_GT(rows, 10);
  EXPECT_TRUE(store.add(result_of(rows, "completed")));
}

TEST_F(StoreTest, AnalysisCountsCellsCausesAndFactors) {
  Store store(folder_ / "a.sqlite", identity_);
  for (std::int64_t i = 0; i < 100; ++i) {
    store.add(result_of(i, i % 2 == 0 || i % 10 < 5 ? "completed" : "fell"));
  }
  const Analysis analysis = analyse(store);
  EXPECT_EQ(analysis.total.trials, 100);
  EXPECT_EQ(analysis.cells.at(0).tally.succeeded, 50);
  EXPECT_EQ(analysis.cells.at(1).tally.succeeded, 20);
  ASSERT_EQ(analysis.failures.size(), 1U);
  EXPECT_EQ(analysis.failures[0].count, 30);
  EXPECT_EQ(analysis.failures[0].examples.front(), 5);
  EXPECT_EQ(analysis.explanations.front().factor, "friction");
  const std::string summary = summary_json(analysis);
  EXPECT_NE(summary.find("\"push.phase\": \"takeoff\""), std::string::npos) << summary;
  EXPECT_NE(summary.find("\"fell_in_landing\": 30"), std::string::npos) << summary;
}

TEST_F(StoreTest, ComparisonPairsTrialsAndRefusesOtherDraws) {
  Store a(folder_ / "a.sqlite", identity_);
  Store b(folder_ / "b.sqlite", identity_);
  for (std::int64_t i = 0; i < 40; ++i) {
    a.add(result_of(i, "completed"));
    if (i < 30) b.add(result_of(i, i < 10 ? "fell" : "completed"));
  }
  const Comparison comparison = compare(a, b);
  EXPECT_EQ(comparison.total.total(), 30);
  EXPECT_EQ(comparison.total.only_a, 10);
  EXPECT_EQ(comparison.cells.at(1).only_a, 5);
  StoreIdentity other = identity_;
  other.pairing = "other draws";
  const Store c(folder_ / "c.sqlite", other);
  EXPECT_THROW((void)compare(a, c), core::ConfigError);
}

TEST_F(StoreTest, ResultsAreWrittenFromTheStoreAlone) {
  const CampaignFolder folder{folder_};
  {
    Store store(folder.store(), identity_);
    for (std::int64_t i = 0; i < 20; ++i)
      store.add(result_of(i, i % 5 == 0 ? "fell" : "completed"));
  }
  write_results(folder);
  for (const fs::path& file :
       {folder.summary(), folder.report(), folder.table(), folder.cells(),
        folder.figures() / "success-friction.svg", folder.figures() / "com-paths-0.svg"}) {
    EXPECT_GT(fs::file_size(file), 100U) << file;
  }
}

}  // namespace
}  // namespace hopscotch::apps::campaign
