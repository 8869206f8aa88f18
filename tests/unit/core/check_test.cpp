#include "core/check.hpp"

#include <gtest/gtest.h>

namespace {

TEST(Check, TrueConditionPassesAndIsEvaluatedOnce) {
  int evaluations = 0;
  HOPSCOTCH_CHECK(++evaluations == 1);
  EXPECT_EQ(evaluations, 1);
}

TEST(CheckDeathTest, FalseConditionNamesItselfAndAborts) {
  const int answer = 41;
  EXPECT_DEATH(HOPSCOTCH_CHECK(answer == 42), "check_test.cpp:.*check failed: answer == 42");
}

}  // namespace
