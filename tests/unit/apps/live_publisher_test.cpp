#include "apps/live_publisher.hpp"

#include <gtest/gtest.h>

#include "apps/live_run.hpp"

namespace hopscotch::apps {
namespace {

msgs::Event event_of(std::size_t bytes) {
  return {.now = {}, .channel = msgs::kStateChannel, .bytes = msgs::Bytes(bytes)};
}

TEST(LivePublisher, SendsWhatItIsGivenBeforeItGoes) {
  msgs::LiveLink link("memq://");
  LivePublisher::Counts counts;
  {
    LivePublisher publisher(link);
    for (int i = 0; i < 100; ++i) publisher.publish(event_of(10));
    while (publisher.counts().sent < 100) std::this_thread::yield();
    counts = publisher.counts();
  }
  EXPECT_EQ(counts.sent, 100U);
  EXPECT_EQ(counts.dropped + counts.failed, 0U);
}

TEST(LivePublisher, DropsAndCountsWhatDoesNotFitIntoTheQueue) {
  msgs::LiveLink link("memq://");
  LivePublisher publisher(link, 50);
  publisher.publish(event_of(51));
  EXPECT_EQ(publisher.counts().dropped, 1U);
}

TEST(CommandBox, IsBounded) {
  CommandBox box;
  int taken = 0;
  while (box.put({}) && taken < 1000) ++taken;
  EXPECT_EQ(taken, 64);
  EXPECT_EQ(box.take_all().size(), 64U);
  EXPECT_TRUE(box.take_all().empty());
  EXPECT_TRUE(box.put({}));
}

TEST(Acks, TellTheChannelTheCommandCameOn) {
  core::OperatorAnswer answer;
  answer.command.sequence = 9;
  answer.remark = "it jumps now";
  EXPECT_EQ(ack_of({}, answer).channel, "HOP_TARGET_CMD");
  EXPECT_EQ(ack_of({}, answer).refusal.sentence, "it jumps now");
  answer.command.mode = core::ModeRequest::hold;
  answer.refusal = {core::Reason::not_now, "no"};
  const msgs::Ack ack = ack_of({}, answer);
  EXPECT_EQ(ack.channel, "HOP_COMMAND_CMD");
  EXPECT_EQ(ack.command_sequence, 9U);
  EXPECT_FALSE(ack.accepted);
  EXPECT_EQ(ack.refusal.sentence, "no");
}

}  // namespace
}  // namespace hopscotch::apps
