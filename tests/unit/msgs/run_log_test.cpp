#include "msgs/run_log.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/unit/msgs/samples.hpp"

namespace hopscotch::msgs {
namespace {

class RunLog : public testing::Test {
 protected:
  RunLog() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("run_log_") + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~RunLog() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file() const { return folder_ / "run.lcm"; }
  static std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  std::filesystem::path folder_;
};

TEST_F(RunLog, ReaderGetsBackWhatTheWriterWroteInOrder) {
  RunLogWriter writer(file(), 5);
  writer.write({1'000'000}, samples::sensors());
  writer.write({2'000'000}, samples::plan());
  writer.write({3'000'000}, samples::sensors());
  writer.close();

  std::vector<std::string> seen;
  RunLogHandlers handlers;
  handlers.sensors = [&](core::Stamp written, const Tagged<core::SensorReadings>& message) {
    seen.push_back("sensors " + std::to_string(message.tag.sequence) + " at " +
                   std::to_string(written.nanoseconds));
    EXPECT_EQ(message.tag.run_id, 5U);
    EXPECT_EQ(message.value.q, samples::sensors().q);
  };
  handlers.plan = [&](core::Stamp, const Tagged<core::JumpPlan>& message) {
    seen.push_back("plan " + std::to_string(message.value.id));
  };
  const RunLogSummary summary = read_run_log(file(), handlers);
  EXPECT_EQ(seen,
            (std::vector<std::string>{"sensors 1 at 1000000", "plan 9", "sensors 2 at 3000000"}));
  EXPECT_EQ(summary.events, 3U);
  EXPECT_EQ(summary.unknown, 0U);
  EXPECT_EQ(summary.malformed, 0U);
}

TEST_F(RunLog, EveryTypeHasItsOwnChannel) {
  RunLogWriter writer(file(), 1);
  writer.write({}, samples::sensors());
  writer.write({}, samples::state());
  writer.write({}, samples::command());
  writer.write({}, samples::plan());
  writer.write({}, samples::terrain());
  writer.write({}, samples::choice());
  writer.write({}, MapView{});
  writer.write({}, TargetCommand{});
  writer.write({}, ModeCommand{});
  writer.write({}, Ack{});
  writer.write({}, samples::status());
  writer.write({}, samples::truth());
  writer.write({}, samples::scene());
  writer.write({}, DepthRecord{.frame = {.intrinsics = {1, 1, 1.0, 1.0, 0.5, 0.5}, .depth = {1.0F}},
                               .at_exposure = samples::state()});
  writer.write({}, AnchorRecord{samples::state()});
  writer.write({}, EstimatorPrior{});
  writer.write({}, TargetQuestion{.rest = samples::state()});
  writer.close();

  int handed_over = 0;
  const auto count = [&](core::Stamp, const auto&) { ++handed_over; };
  const RunLogHandlers handlers{count, count, count, count, count, count, count, count, count,
                                count, count, count, count, count, count, count, count};
  const RunLogSummary summary = read_run_log(file(), handlers);
  EXPECT_EQ(handed_over, 17);
  EXPECT_EQ(summary.events, 17U);
  EXPECT_EQ(summary.malformed + summary.unknown, 0U);
}

TEST_F(RunLog, EqualRunsGiveEqualFiles) {
  for (const char* name : {"a.lcm", "b.lcm"}) {
    RunLogWriter writer(folder_ / name, 3);
    writer.write({10}, samples::status());
    writer.write({20}, samples::truth());
    writer.close();
  }
  EXPECT_EQ(contents(folder_ / "a.lcm"), contents(folder_ / "b.lcm"));
}

TEST_F(RunLog, DamagedMessageIsCountedAndNotHandedOver) {
  RunLogWriter writer(file(), 1);
  writer.write({}, samples::command());
  writer.write({}, samples::command());
  writer.close();
  std::string bytes = contents(file());
  const std::size_t channel = bytes.find("HOP_COMMAND");
  ASSERT_NE(channel, std::string::npos);
  bytes[channel + std::string("HOP_COMMAND").size()] ^= 0x01;  // first byte of the type's hash
  std::ofstream(file(), std::ios::binary) << bytes;

  int handed_over = 0;
  RunLogHandlers handlers;
  handlers.command = [&](core::Stamp, const Tagged<core::JointCommand>&) { ++handed_over; };
  const RunLogSummary summary = read_run_log(file(), handlers);
  EXPECT_EQ(handed_over, 1);
  EXPECT_EQ(summary.malformed, 1U);
}

TEST_F(RunLog, LogCutShortEndsEarly) {
  RunLogWriter writer(file(), 1);
  writer.write({}, samples::sensors());
  writer.write({}, samples::sensors());
  writer.close();
  std::filesystem::resize_file(file(), std::filesystem::file_size(file()) - 10);
  EXPECT_EQ(read_run_log(file(), {}).events, 1U);
}

TEST_F(RunLog, FilesThatCannotBeOpenedAreNamed) {
  EXPECT_THROW(RunLogWriter(folder_ / "missing" / "run.lcm", 1), std::runtime_error);
  EXPECT_THROW(read_run_log(folder_ / "missing.lcm", {}), std::runtime_error);
}

}  // namespace
}  // namespace hopscotch::msgs
