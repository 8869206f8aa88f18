#include "apps/campaign/trial_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <set>

namespace hopscotch::apps::campaign {
namespace {

CampaignSpec spec_of(int trials, std::optional<StopRule> stop) {
  CampaignSpec spec;
  spec.trials = trials;
  spec.stop = stop;
  Factor factor;
  factor.name = "friction";
  factor.kind = Factor::Kind::grid;
  factor.values = {0.4, 0.8};
  factor.labels = {"0.4", "0.8"};
  spec.factors = {factor};
  return spec;
}

/// Cell 0 always succeeds, cell 1 every other time.
TrialQueue::Verdict verdict_of(std::int64_t index) {
  const TrialPlace place = place_of(index, 2);
  return place.cell == 0 || place.repetition % 2 == 0 ? TrialQueue::Verdict::success
                                                      : TrialQueue::Verdict::failure;
}

/// Runs a queue with so many trials under way at once, which end in reverse order.
std::set<std::int64_t> run_all(TrialQueue& queue, std::size_t workers) {
  std::set<std::int64_t> done;
  std::deque<std::int64_t> running;
  while (true) {
    while (running.size() < workers) {
      const std::optional<std::int64_t> next = queue.next();
      if (!next) break;
      running.push_front(*next);
    }
    if (running.empty()) return done;
    EXPECT_TRUE(done.insert(running.front()).second) << "run twice: " << running.front();
    queue.finished(running.front(), verdict_of(running.front()));
    running.pop_front();
  }
}

TEST(TrialQueue, GivesEveryTrialOnceInOrder) {
  TrialQueue queue(spec_of(5, std::nullopt));
  for (std::int64_t i = 0; i < 10; ++i) EXPECT_EQ(queue.next(), i);
  EXPECT_EQ(queue.next(), std::nullopt);
  EXPECT_FALSE(queue.complete());
  for (std::int64_t i = 0; i < 10; ++i) queue.finished(i, verdict_of(i));
  EXPECT_TRUE(queue.complete());
}

TEST(TrialQueue, SkipsWhatIsFinishedAndRepeatsWhatIsGivenBack) {
  TrialQueue queue(spec_of(3, std::nullopt));
  queue.finished(0, TrialQueue::Verdict::success);
  queue.finished(2, TrialQueue::Verdict::failure);
  EXPECT_EQ(queue.next(), 1);
  EXPECT_EQ(queue.next(), 3);
  queue.give_back(1);
  EXPECT_EQ(queue.next(), 1);
  EXPECT_EQ(queue.next(), 4);
}

TEST(TrialQueue, StopsACellOnceItsRateIsKnown) {
  TrialQueue queue(spec_of(100'000, StopRule{.half_width = 0.05, .at_least = 50}));
  const std::set<std::int64_t> done = run_all(queue, 1);
  EXPECT_TRUE(queue.complete());
  const auto second = std::count_if(done.begin(), done.end(), [](auto i) { return i % 2 == 1; });
  EXPECT_EQ(static_cast<std::int64_t>(done.size()) - second, 50);  // 50 of 50: 0.036
  EXPECT_EQ(second, 400);  // half of n: 1.96 / 2 / sqrt(n + 3.84) <= 0.05 from 381 on
}

TEST(TrialQueue, WhatIsRunDependsNeitherOnWorkersNorOnInterruptions) {
  const CampaignSpec spec = spec_of(1000, StopRule{.half_width = 0.06, .at_least = 40});
  TrialQueue alone(spec);
  const std::set<std::int64_t> expected = run_all(alone, 1);
  TrialQueue crowded(spec);
  EXPECT_EQ(run_all(crowded, 7), expected);
  TrialQueue resumed(spec);
  std::set<std::int64_t> before;
  for (const std::int64_t index : expected) {
    if (index % 3 != 0) continue;
    before.insert(index);
    resumed.finished(index, verdict_of(index));
  }
  std::set<std::int64_t> together = run_all(resumed, 3);
  together.insert(before.begin(), before.end());
  EXPECT_EQ(together, expected);
}

}  // namespace
}  // namespace hopscotch::apps::campaign
