#include "apps/stage.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <semaphore>
#include <thread>
#include <vector>

namespace hopscotch::apps {
namespace {

core::Stamp at(double seconds) {
  return core::Stamp::from_seconds(seconds);
}

using Doubling = Stage<int, int>;

StageSetup setup(bool threaded, double latency = 0.010) {
  return {.name = "doubling", .latency = latency, .threaded = threaded, .thread = {}};
}

void twice(const int& question, int& answer) {
  answer = 2 * question;
}

/// Until the stage's thread has done its work.
template <typename Done>
void wait_for(Done done) {
  while (!done()) std::this_thread::sleep_for(std::chrono::microseconds(100));
}

TEST(Stage, InLockStepTheAnswerIsMadeAtOnceAndCountsAfterTheLatency) {
  Doubling stage(setup(false), twice);
  stage.question() = 21;
  stage.ask(at(1.0));
  ASSERT_NE(stage.made(), nullptr);
  EXPECT_EQ(stage.made(), nullptr);  // shown once
  EXPECT_EQ(stage.take(at(1.0099)), nullptr);
  EXPECT_FALSE(stage.vacant());
  const int* const answer = stage.take(at(1.010));
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(*answer, 42);
  EXPECT_TRUE(stage.vacant());
  EXPECT_EQ(stage.take(at(2.0)), nullptr);
}

TEST(Stage, WhatIsTakenHasBeenShown) {
  Doubling stage(setup(false), twice);
  stage.ask(at(0.0));
  EXPECT_EQ(stage.take(at(1.0)), nullptr);
  EXPECT_NE(stage.made(), nullptr);
  EXPECT_NE(stage.take(at(1.0)), nullptr);
}

TEST(Stage, ADroppedAnswerNeverComes) {
  Doubling stage(setup(false), twice);
  stage.ask(at(0.0));
  stage.drop();
  EXPECT_TRUE(stage.vacant());
  EXPECT_EQ(stage.made(), nullptr);
  EXPECT_EQ(stage.take(at(1.0)), nullptr);
}

TEST(Stage, OnAThreadTheAskingOneNeverWaits) {
  std::binary_semaphore go(0);
  Doubling stage(setup(true), [&](const int& question, int& answer) {
    go.acquire();
    answer = 2 * question;
  });
  stage.question() = 4;
  stage.ask(at(0.0));
  EXPECT_EQ(stage.made(), nullptr);
  EXPECT_EQ(stage.take(at(0.5)), nullptr);
  EXPECT_FALSE(stage.vacant());
  go.release();
  wait_for([&] { return stage.made() != nullptr; });
  const int* const answer = stage.take(at(0.5));
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(*answer, 8);
  EXPECT_EQ(stage.late(), 1U);
}

TEST(Stage, OnAThreadAnAnswerBeforeItsTimeIsHeldBackToo) {
  Doubling stage(setup(true), twice);
  stage.question() = 1;
  stage.ask(at(0.0));
  wait_for([&] { return stage.made() != nullptr; });
  EXPECT_EQ(stage.take(at(0.009)), nullptr);
  EXPECT_NE(stage.take(at(0.010)), nullptr);
  EXPECT_EQ(stage.late(), 0U);
}

TEST(Stage, ADroppedQuestionOccupiesItsThreadUntilTheWorkIsDone) {
  std::binary_semaphore go(0);
  Doubling stage(setup(true), [&](const int&, int&) { go.acquire(); });
  stage.ask(at(0.0));
  stage.drop();
  EXPECT_FALSE(stage.vacant());
  go.release();
  wait_for([&] { return stage.take(at(1.0)) == nullptr && stage.vacant(); });
  EXPECT_EQ(stage.made(), nullptr);
}

TEST(Stage, ManyQuestionsGetTheirOwnAnswers) {
  Doubling stage(setup(true, 0.0), twice);
  for (int i = 0; i < 2000; ++i) {
    stage.question() = i;
    stage.ask(at(i));
    wait_for([&] { return stage.made() != nullptr; });
    const int* const answer = stage.take(at(i));
    ASSERT_NE(answer, nullptr);
    ASSERT_EQ(*answer, 2 * i);
  }
}

TEST(Stage, EndsWhileWorkingAndWhileIdle) {
  { const Doubling idle(setup(true), twice); }
  std::binary_semaphore working(0);
  Doubling busy(setup(true), [&](const int&, int&) { working.release(); });
  busy.ask(at(0.0));
  working.acquire();
}

}  // namespace
}  // namespace hopscotch::apps
