#include "apps/operator_desk.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hopscotch::apps {
namespace {

using core::Reason;
using Mode = OperatorDesk::Mode;

core::OperatorCommand target_at(double distance, std::uint64_t sequence) {
  core::OperatorCommand command;
  command.sequence = sequence;
  command.target = core::TargetOverride{.distance = distance};
  return command;
}

TEST(OperatorDesk, ATargetWaitsUntilItHasBeenJudged) {
  OperatorDesk desk;
  desk.take_target(target_at(0.3, 1));
  EXPECT_TRUE(desk.take_answers().empty());
  ASSERT_TRUE(desk.due());
  EXPECT_EQ(desk.due()->distance, 0.3);

  desk.accept_target(0.4);
  const auto answers = desk.take_answers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0].accepted());
  EXPECT_EQ(answers[0].command.sequence, 1U);
  EXPECT_EQ(answers[0].start_in, 0.4);
  EXPECT_FALSE(desk.due()) << "an override holds for one jump";
}

TEST(OperatorDesk, ARefusedTargetIsForgotten) {
  OperatorDesk desk;
  desk.take_target(target_at(0.3, 1));
  desk.refuse_target({Reason::gap_too_wide, "0.9 m"});
  const auto answers = desk.take_answers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].refusal.reason, Reason::gap_too_wide);
  EXPECT_FALSE(desk.due());
}

TEST(OperatorDesk, ARefusalTellsWhenATargetMayBeAskedAgain) {
  OperatorDesk desk;
  desk.take_target(target_at(0.3, 1));
  desk.refuse_target({Reason::not_now, "locked"}, 0.4);
  desk.take_target(target_at(0.3, 2));
  desk.refuse_target({Reason::out_of_reach, ""});
  const auto answers = desk.take_answers();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].start_in, 0.4);
  EXPECT_TRUE(std::isnan(answers[1].start_in)) << "never";
}

TEST(OperatorDesk, ANewerTargetReplacesTheOlderWhichIsTold) {
  OperatorDesk desk;
  desk.take_target(target_at(0.3, 1));
  desk.take_target(target_at(0.4, 2));
  const auto answers = desk.take_answers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].command.sequence, 1U);
  EXPECT_EQ(answers[0].refusal.reason, Reason::withdrawn);
  EXPECT_EQ(desk.due()->distance, 0.4);
}

TEST(OperatorDesk, ClearingDropsTheTargetAndTellsItsSender) {
  OperatorDesk desk;
  EXPECT_FALSE(desk.withdraw_target("cleared"));
  desk.take_target(target_at(0.3, 1));
  EXPECT_TRUE(desk.withdraw_target("cleared"));
  EXPECT_EQ(desk.take_answers().at(0).refusal.reason, Reason::withdrawn);
  EXPECT_FALSE(desk.due());
}

TEST(OperatorDesk, NumbersThatAreNoneAreRefusedAtOnce) {
  OperatorDesk desk;
  desk.take_target(target_at(core::kNaN, 1));
  EXPECT_EQ(desk.take_answers().at(0).refusal.reason, Reason::target_malformed);
  EXPECT_FALSE(desk.due());
}

TEST(OperatorDesk, ATargetGivenWhileHeldIsCheckedAndWaitsForTheRelease) {
  OperatorDesk desk;
  desk.set_mode(Mode::held);
  desk.take_target(target_at(0.3, 1));
  ASSERT_TRUE(desk.due());
  EXPECT_TRUE(desk.check_only());
  desk.accept_target(0.0);
  EXPECT_TRUE(desk.take_answers().at(0).accepted());
  EXPECT_FALSE(desk.due()) << "checked once";

  desk.set_mode(Mode::free);
  ASSERT_TRUE(desk.due());
  EXPECT_FALSE(desk.check_only());
  desk.accept_target(0.0);
  EXPECT_TRUE(desk.take_answers().empty()) << "answered already";
  EXPECT_FALSE(desk.due());
}

TEST(OperatorDesk, APromiseThatCannotBeKeptIsTakenBack) {
  OperatorDesk desk;
  desk.set_mode(Mode::held);
  desk.take_target(target_at(0.3, 1));
  desk.accept_target(0.0);
  EXPECT_EQ(desk.take_answers().size(), 1U);
  desk.set_mode(Mode::free);
  desk.refuse_target({Reason::terrain_unseen, ""});
  EXPECT_EQ(desk.take_answers().at(0).refusal.reason, Reason::terrain_unseen);
}

/// @param mode In which the newer target is judged.
OperatorDesk desk_with_a_promise(Mode mode) {
  OperatorDesk desk;
  desk.set_mode(Mode::held);
  desk.take_target(target_at(0.45, 1));
  desk.accept_target(0.0);
  desk.set_mode(mode);
  desk.take_target(target_at(0.25, 2));
  EXPECT_EQ(desk.take_answers().size(), 1U);
  return desk;
}

TEST(OperatorDesk, APromiseStandsWhenANewerTargetIsRefused) {
  for (const Mode mode : {Mode::held, Mode::free}) {
    OperatorDesk desk = desk_with_a_promise(mode);
    desk.refuse_target({Reason::no_safe_target, "a pit"});
    EXPECT_EQ(desk.take_answers().at(0).refusal.sentence,
              "a pit; the target accepted before stands");
    desk.set_mode(Mode::free);
    ASSERT_TRUE(desk.due());
    EXPECT_EQ(desk.due()->distance, 0.45);
    desk.refuse_target({Reason::no_safe_target, "a pit"});
    EXPECT_EQ(desk.take_answers().at(0).refusal.sentence, "a pit");
    EXPECT_FALSE(desk.due());
  }
}

TEST(OperatorDesk, APromiseEndsWhenANewerTargetIsAcceptedOrAllAreDropped) {
  OperatorDesk desk = desk_with_a_promise(Mode::held);
  desk.accept_target(0.0);
  desk.set_mode(Mode::free);
  EXPECT_EQ(desk.due()->distance, 0.25);

  OperatorDesk cleared = desk_with_a_promise(Mode::held);
  EXPECT_TRUE(cleared.withdraw_target("cleared"));
  cleared.set_mode(Mode::free);
  EXPECT_FALSE(cleared.due());
}

TEST(OperatorDesk, AStoppingRunTakesNoTargets) {
  OperatorDesk desk;
  desk.take_target(target_at(0.3, 1));
  desk.set_mode(Mode::stopping);
  desk.take_target(target_at(0.4, 2));
  const auto answers = desk.take_answers();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].refusal.reason, Reason::withdrawn);
  EXPECT_EQ(answers[1].refusal.reason, Reason::not_now);
}

}  // namespace
}  // namespace hopscotch::apps
