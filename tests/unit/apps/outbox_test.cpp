#include "apps/outbox.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "apps/console.hpp"
#include "apps/live_run.hpp"
#include "core/allocation_count.hpp"

namespace hopscotch::apps {
namespace {

TEST(Outbox, DeliversInOrderBeforeItGoes) {
  std::vector<int> got;
  {
    Outbox<int> outbox(
        [&got](int item) {
          got.push_back(item);
          return true;
        },
        {.bytes = 1000});
    for (int i = 0; i < 100; ++i) outbox.put(i, 1);
  }
  ASSERT_EQ(got.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(got[static_cast<std::size_t>(i)], i);
}

TEST(Outbox, CountsWhatIsSentAndWhatFails) {
  Outbox<bool> outbox([](bool well) { return well; }, {.bytes = 1000});
  for (const bool well : {true, false, true}) outbox.put(well, 1);
  while (outbox.counts().sent + outbox.counts().failed < 3) std::this_thread::yield();
  EXPECT_EQ(outbox.counts().sent, 2U);
  EXPECT_EQ(outbox.counts().failed, 1U);
}

TEST(Outbox, DropsAndCountsWhatDoesNotFitIntoTheQueue) {
  Outbox<int> outbox([](int) { return true; }, {.bytes = 50});
  outbox.put(1, 51);
  EXPECT_EQ(outbox.counts().dropped, 1U);
}

TEST(Outbox, DropsAndCountsWhatFindsNoPlace) {
  std::atomic<bool> blocked{true};
  std::vector<int> got;
  {
    Outbox<int> outbox(
        [&](int item) {
          blocked.wait(true);
          got.push_back(item);
          return true;
        },
        {.bytes = 1000, .items = 4});
    for (int i = 0; i < 100; ++i) outbox.put(i, 1);
    EXPECT_GE(outbox.counts().dropped, 95U);  // four places, one in delivery
    blocked = false;
    blocked.notify_all();
  }
  ASSERT_GE(got.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(got[i], static_cast<int>(i));
}

TEST(Outbox, PuttingTakesNothingFromTheHeap) {
  std::atomic<int> got{0};
  Outbox<std::array<char, 500>> outbox(
      [&](const auto&) {
        ++got;
        return true;
      },
      {.bytes = 1U << 20U});
  const std::size_t before = core::allocation_count();
  for (int i = 0; i < 5000; ++i) outbox.put({}, 500);
  EXPECT_EQ(core::allocation_count(), before);
  while (outbox.counts().sent + outbox.counts().dropped < 5000) std::this_thread::yield();
  EXPECT_GT(got, 0);
}

TEST(Outbox, ActsWheneverNothingHasCome) {
  std::atomic<int> acted{0};
  Outbox<int> outbox([](int) { return true; }, {.bytes = 10},
                     {.after = std::chrono::milliseconds(1), .act = [&] { ++acted; }});
  while (acted < 3) std::this_thread::yield();
  outbox.put(1, 1);
  const int then = acted;
  while (acted < then + 3) std::this_thread::yield();
  EXPECT_EQ(outbox.counts().sent, 1U);
}

/// Both ends of a pipe.
struct Pipe {
  Pipe() { EXPECT_EQ(pipe(ends.data()), 0); }
  ~Pipe() {
    for (const int end : ends) close(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  std::array<int, 2> ends{};
};

TEST(Console, WritesWholeLines) {
  const Pipe pipe;
  { Console(pipe.ends[1]).say("jump %d of %s", 3, "five"); }
  std::array<char, 100> text{};
  const ssize_t length = read(pipe.ends[0], text.data(), text.size());
  ASSERT_GT(length, 0);
  EXPECT_EQ(std::string(text.data(), static_cast<std::size_t>(length)), "jump 3 of five\n");
}

TEST(Console, NobodyWaitsForATerminalThatTakesNothing) {
  const Pipe pipe;
  const std::string page(4096, 'x');
  fcntl(pipe.ends[1], F_SETFL, O_NONBLOCK);
  while (write(pipe.ends[1], page.data(), page.size()) > 0) {
  }
  fcntl(pipe.ends[1], F_SETFL, 0);  // as a terminal is: a write waits
  Console console(pipe.ends[1]);
  console.say("lost");
  for (int i = 0; i < 10000; ++i) console.say("%s", page.c_str());
  EXPECT_GT(console.counts().dropped, 0U);
  EXPECT_EQ(console.counts().sent, 0U);
}

TEST(Console, SayingTakesNothingFromTheHeap) {
  const Pipe pipe;
  Console console(pipe.ends[1]);
  const std::size_t before = core::allocation_count();
  for (int i = 0; i < 10; ++i) console.say("robot: %.3f s: jump %d of %s", 1.5, i, "five");
  EXPECT_EQ(core::allocation_count(), before);
}

/// Who made the words, and of what.
struct Fact {
  int number = 0;
  std::thread::id teller;
};
std::string words_of(const Fact& fact) {
  return "number " + std::to_string(fact.number) +
         (fact.teller == std::this_thread::get_id() ? " told by the loop" : "");
}

TEST(Console, WordsOfFactsAreMadeByItsOwnThread) {
  const Pipe pipe;
  {
    Console console(pipe.ends[1]);
    const std::size_t before = core::allocation_count();
    console.tell<words_of>(Fact{7, std::this_thread::get_id()});
    EXPECT_EQ(core::allocation_count(), before);
  }
  std::array<char, 100> text{};
  const ssize_t length = read(pipe.ends[0], text.data(), text.size());
  ASSERT_GT(length, 0);
  EXPECT_EQ(std::string(text.data(), static_cast<std::size_t>(length)), "number 7\n");
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
