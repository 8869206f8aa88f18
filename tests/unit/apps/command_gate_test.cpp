#include "apps/command_gate.hpp"

#include <gtest/gtest.h>

namespace hopscotch::apps {
namespace {

using core::Reason;

constexpr std::uint64_t kRun = 0xabc;
constexpr std::uint64_t kOpened = 1'000'000'000;
constexpr std::uint64_t kSecond = 1'000'000;  // [us]

core::OperatorCommand made_at(std::uint64_t time, std::uint64_t run = kRun) {
  core::OperatorCommand command;
  command.run_id = run;
  command.sequence = time;
  return command;
}

TEST(CommandGate, LetsFreshCommandsInInTheirOrder) {
  CommandGate gate(kRun, kOpened);
  for (std::uint64_t i = 1; i < 5; ++i) {
    const std::uint64_t made = kOpened + i * kSecond;
    EXPECT_EQ(gate.check(made_at(made), made + 1000).reason, Reason::none);
  }
}

TEST(CommandGate, RefusesTheSameCommandTwice) {
  CommandGate gate(kRun, kOpened);
  const core::OperatorCommand command = made_at(kOpened + kSecond);
  EXPECT_EQ(gate.check(command, kOpened + kSecond).reason, Reason::none);
  EXPECT_EQ(gate.check(command, kOpened + kSecond).reason, Reason::repeated_command);
}

TEST(CommandGate, RefusesACommandThatAnOvertakenOneFollows) {
  CommandGate gate(kRun, kOpened);
  const std::uint64_t now = kOpened + 2 * kSecond;
  EXPECT_EQ(gate.check(made_at(now), now).reason, Reason::none);
  EXPECT_EQ(gate.check(made_at(now - kSecond), now).reason, Reason::repeated_command);
}

TEST(CommandGate, RefusesRecordingsFromBeforeTheRun) {
  CommandGate gate(kRun, kOpened);
  EXPECT_EQ(gate.check(made_at(kOpened - 1), kOpened + kSecond).reason, Reason::stale_command);
}

TEST(CommandGate, RefusesCommandsThatTookTooLong) {
  CommandGate gate(kRun, kOpened);
  const std::uint64_t made = kOpened + kSecond;
  EXPECT_EQ(gate.check(made_at(made), made + 6 * kSecond).reason, Reason::stale_command);
}

TEST(CommandGate, RefusesCommandsFromTheFuture) {
  CommandGate gate(kRun, kOpened);
  EXPECT_EQ(gate.check(made_at(~std::uint64_t{0}), kOpened + kSecond).reason,
            Reason::stale_command);
  // A forged one must not lock later ones out.
  EXPECT_EQ(gate.check(made_at(kOpened + kSecond), kOpened + kSecond).reason, Reason::none);
}

TEST(CommandGate, RefusesCommandsForOtherRunsAndNamesBoth) {
  CommandGate gate(kRun, kOpened);
  const core::Refusal refusal = gate.check(made_at(kOpened + 1, 0xdef), kOpened + 1);
  EXPECT_EQ(refusal.reason, Reason::wrong_run);
  EXPECT_NE(refusal.sentence.find("0000000000000def"), std::string::npos);
  EXPECT_NE(refusal.sentence.find("0000000000000abc"), std::string::npos);
}

TEST(RunId, TextAndNumberAgree) {
  std::uint64_t id = 0;
  EXPECT_TRUE(parse_run_id(run_id_text(0x0123456789abcdef), id));
  EXPECT_EQ(id, 0x0123456789abcdefU);
  EXPECT_TRUE(parse_run_id("ff", id));
  EXPECT_EQ(id, 0xffU);
  for (const char* bad : {"", "xyz", "12 ", "00112233445566778", "-1"}) {
    EXPECT_FALSE(parse_run_id(bad, id)) << bad;
  }
}

}  // namespace
}  // namespace hopscotch::apps
