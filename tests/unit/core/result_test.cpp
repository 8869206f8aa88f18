#include "core/result.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace hopscotch::core {
namespace {

Result<std::string> answer() {
  return std::string("yes");
}
Result<std::string> refusal() {
  return Refusal{.reason = Reason::no_safe_target, .sentence = "no"};
}

TEST(Result, HoldsAValue) {
  const Result<std::string> result = answer();
  ASSERT_TRUE(result.has_value());
  EXPECT_TRUE(static_cast<bool>(result));
  EXPECT_EQ(result.value(), "yes");
  EXPECT_EQ(*result, "yes");
  EXPECT_EQ(result->size(), 3U);
}

TEST(Result, HoldsARefusal) {
  const Result<std::string> result = refusal();
  ASSERT_FALSE(result.has_value());
  EXPECT_FALSE(static_cast<bool>(result));
  EXPECT_EQ(result.error().reason, Reason::no_safe_target);
  EXPECT_EQ(result.error().sentence, "no");
}

TEST(Result, ValueCanBeChangedAndMovedOut) {
  Result<std::unique_ptr<int>> result(std::make_unique<int>(3));
  *result.value() = 4;
  const std::unique_ptr<int> moved = std::move(result.value());
  EXPECT_EQ(*moved, 4);
}

TEST(ResultDeathTest, ValueOfARefusalAborts) {
  const Result<std::string> result = refusal();
  EXPECT_DEATH(static_cast<void>(result.value()), "check failed: has_value");
}

TEST(ResultDeathTest, ErrorOfAValueAborts) {
  const Result<std::string> result = answer();
  EXPECT_DEATH(static_cast<void>(result.error()), "check failed: !has_value");
}

}  // namespace
}  // namespace hopscotch::core
