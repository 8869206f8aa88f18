#include "msgs/live_link.hpp"

#include <gtest/gtest.h>

#include "msgs/event.hpp"
#include "tests/unit/msgs/samples.hpp"

namespace hopscotch::msgs {
namespace {

// "memq://" hands messages over within one LiveLink: no network takes part in these tests.
constexpr const char* kWithin = "memq://";
constexpr int kNoWait_ms = 100;

TEST(LiveLink, HandsOverWhatWasPublished) {
  int states = 0;
  RunLogHandlers handlers;
  handlers.state = [&](core::Stamp, const Tagged<core::RobotState>& message) {
    ++states;
    EXPECT_EQ(message.tag.run_id, 7U);
    EXPECT_EQ(message.value.q, samples::state().q);
  };
  LiveLink link(kWithin, handlers);
  EventMaker maker(7);
  const Event event = maker.make({}, samples::state());
  EXPECT_TRUE(link.publish(event.channel, event.bytes));
  EXPECT_TRUE(link.receive(kNoWait_ms));
  EXPECT_EQ(states, 1);
  EXPECT_FALSE(link.receive(0));
}

TEST(LiveLink, HostileBytesAreCountedAndHandedToNobody) {
  int commands = 0;
  RunLogHandlers handlers;
  handlers.target_command = [&](core::Stamp, const auto&) { ++commands; };
  LiveLink link(kWithin, handlers);
  Bytes bytes = encode(TargetCommand{}, {1, 1});
  bytes.pop_back();
  EXPECT_TRUE(link.publish(kTargetCommandChannel, bytes));
  EXPECT_TRUE(link.publish(kTargetCommandChannel, Bytes{}));
  EXPECT_TRUE(link.publish(kTargetCommandChannel, Bytes(70'000, 0xff)));
  while (link.receive(kNoWait_ms)) {
  }
  EXPECT_EQ(commands, 0);
  EXPECT_EQ(link.received().malformed, 3U);
}

TEST(LiveLink, AnAddressThatIsNoneIsNamed) {
  try {
    const LiveLink link("carrier-pigeon://nest");
    FAIL();
  } catch (const LiveUnavailable& error) {
    EXPECT_NE(std::string(error.what()).find("carrier-pigeon"), std::string::npos);
  }
}

TEST(EventMaker, NumbersEachChannelFromOne) {
  EventMaker maker(3);
  const Event first = maker.make({5}, samples::state());
  static_cast<void>(maker.make({6}, samples::status()));
  const Event second = maker.make({7}, samples::state());
  EXPECT_EQ(decode<core::RobotState>(first.bytes)->tag.sequence, 1U);
  EXPECT_EQ(decode<core::RobotState>(second.bytes)->tag.sequence, 2U);
  EXPECT_EQ(second.now.nanoseconds, 7);
  EXPECT_EQ(second.channel, kStateChannel);
}

}  // namespace
}  // namespace hopscotch::msgs
