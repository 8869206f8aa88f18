#include "apps/operator_client.hpp"

#include <gtest/gtest.h>

namespace hopscotch::apps {
namespace {

TEST(OperatorClient, OneSenderCountsUp) {
  std::vector<RunOnAir> runs;
  for (const std::uint64_t sequence : {7U, 8U, 12U}) note_status({sequence, 3}, runs);
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_TRUE(runs[0].is_alone);
}

TEST(OperatorClient, TwoRunsOfOneIdAreTold) {
  std::vector<RunOnAir> runs;
  for (const std::uint64_t sequence : {700U, 8U, 701U}) note_status({sequence, 3}, runs);
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_FALSE(runs[0].is_alone);
}

TEST(OperatorClient, RunsOfOtherIdsAreApart) {
  std::vector<RunOnAir> runs;
  note_status({700, 3}, runs);
  note_status({8, 4}, runs);
  note_status({701, 3}, runs);
  note_status({9, 4}, runs);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_TRUE(runs[0].is_alone);
  EXPECT_TRUE(runs[1].is_alone);
}

}  // namespace
}  // namespace hopscotch::apps
