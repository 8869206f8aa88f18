#include "apps/real_time.hpp"

#include <gtest/gtest.h>

namespace hopscotch::apps {
namespace {

TEST(PeriodicWake, KeepsPeriodsOfTheClockThatItTells) {
  constexpr double kPeriod = 0.001;  // [s]
  constexpr double kSlowdown = 8.0;
  const core::Stamp begin = slowed_clock(kSlowdown);
  PeriodicWake wake(kPeriod, kSlowdown);
  core::Stamp last;
  for (int i = 0; i < 5; ++i) last = wake.wait();
  EXPECT_GE(last.since(begin), 5.0 * kPeriod - 1e-6);
  EXPECT_LE(last, slowed_clock(kSlowdown));
}

TEST(PeriodicWake, ItsSlowedClockTakesLongerForASecond) {
  const core::Stamp before = slowed_clock(1.0);
  const core::Stamp slow = slowed_clock(100.0);
  const core::Stamp after = slowed_clock(1.0);
  constexpr double kRounding = 1e-6;  // [s]
  EXPECT_GE(100.0 * slow.seconds(), before.seconds() - kRounding);
  EXPECT_LE(100.0 * slow.seconds(), after.seconds() + kRounding);
}

}  // namespace
}  // namespace hopscotch::apps
