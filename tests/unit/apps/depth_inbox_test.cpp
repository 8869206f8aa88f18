#include "apps/depth_inbox.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "msgs/event.hpp"
#include "tests/scenario/own_network.hpp"

namespace hopscotch::apps {
namespace {

msgs::DepthRecord frame_at(std::int64_t stamp_ns) {
  msgs::DepthRecord record;
  record.frame.stamp = {stamp_ns};
  record.frame.intrinsics = {2, 1, 1.0, 1.0, 1.0, 0.5};
  record.frame.depth = {1.25F, 0.5F};
  return record;
}

class DepthInboxTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { use_own_network(); }

  void SetUp() override {
    const std::string url(msgs::kDefaultUrl);
    inbox_ = std::make_unique<DepthInbox>(url);
    link_ = std::make_unique<msgs::LiveLink>(url);
  }

  void send(std::int64_t stamp_ns) {
    const msgs::Event event = events_.make({}, frame_at(stamp_ns));
    ASSERT_TRUE(link_->publish(event.channel, event.bytes));
  }
  std::optional<core::DepthFrame> wait_for_frame(core::Stamp now) {
    for (int i = 0; i < 200; ++i) {
      if (auto frame = inbox_->poll(now)) return frame;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return std::nullopt;
  }

  std::unique_ptr<DepthInbox> inbox_;
  std::unique_ptr<msgs::LiveLink> link_;
  msgs::EventMaker events_{1};
};

TEST_F(DepthInboxTest, HandsOverWhatIsSentOldestFirst) {
  send(1'000'000);
  send(2'000'000);
  const auto first = wait_for_frame({5'000'000});
  const auto second = wait_for_frame({5'000'000});
  ASSERT_TRUE(first);
  ASSERT_TRUE(second);
  EXPECT_EQ(first->stamp.nanoseconds, 1'000'000);
  EXPECT_EQ(first->depth, (std::vector<float>{1.25F, 0.5F}));
  EXPECT_EQ(second->stamp.nanoseconds, 2'000'000);
  EXPECT_FALSE(inbox_->poll({5'000'000}));
}

TEST_F(DepthInboxTest, KeepsAFrameFromTheFutureUntilItsTime) {
  send(9'000'000);
  ASSERT_TRUE(wait_for_frame({9'000'000}));
  send(20'000'000);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(inbox_->poll({19'000'000}));
  EXPECT_TRUE(wait_for_frame({20'000'000}));
}

TEST_F(DepthInboxTest, LosesTheOldestWhenNobodyTakesThem) {
  constexpr int kSent = 12;
  for (int i = 1; i <= kSent; ++i) {
    send(i);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  for (int i = 0; i < 200 && inbox_->lost() == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_GT(inbox_->lost(), 0U);
  const auto oldest = wait_for_frame({100});
  ASSERT_TRUE(oldest);
  EXPECT_GT(oldest->stamp.nanoseconds, 1);
}

}  // namespace
}  // namespace hopscotch::apps
