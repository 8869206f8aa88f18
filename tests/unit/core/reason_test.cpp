#include "core/reason.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace hopscotch::core {
namespace {

constexpr int kReasons = static_cast<int>(Reason::internal_error) + 1;

TEST(Reason, EveryCodeIsUnique) {
  std::set<std::string_view> codes;
  for (int i = 0; i < kReasons; ++i) {
    EXPECT_TRUE(codes.insert(reason_code(static_cast<Reason>(i))).second)
        << "second use of '" << reason_code(static_cast<Reason>(i)) << "'";
  }
}

TEST(Reason, CodesAreLowerCaseWords) {
  for (int i = 1; i < kReasons; ++i) {
    const std::string_view code = reason_code(static_cast<Reason>(i));
    EXPECT_FALSE(code.empty());
    EXPECT_EQ(code.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string_view::npos)
        << code;
  }
}

TEST(Reason, NoneIsTheEmptyCode) {
  EXPECT_EQ(reason_code(Reason::none), "");
}

TEST(Refusal, TextIsCodeAndSentence) {
  const Refusal refusal{.reason = Reason::gap_too_wide, .sentence = "gap of 0.9 m, reach 0.6 m"};
  EXPECT_EQ(refusal.text(), "gap_too_wide: gap of 0.9 m, reach 0.6 m");
  EXPECT_EQ((Refusal{.reason = Reason::deadline, .sentence = {}}).text(), "deadline");
}

}  // namespace
}  // namespace hopscotch::core
