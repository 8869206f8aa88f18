#include "core/time.hpp"

#include <gtest/gtest.h>

namespace hopscotch::core {
namespace {

TEST(Stamp, ThousandTicksAreExactlyOneSecond) {
  Stamp stamp;
  for (int tick = 0; tick < 1000; ++tick) stamp = stamp.after(0.001);
  EXPECT_EQ(stamp, Stamp::from_seconds(1.0));
}

TEST(Stamp, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(Stamp::from_seconds(1.6e-9).nanoseconds, 2);
  EXPECT_EQ(Stamp::from_seconds(-1.6e-9).nanoseconds, -2);
  EXPECT_EQ(Stamp::from_seconds(0.3).nanoseconds, 300000000);
}

TEST(Stamp, SinceUndoesAfter) {
  const Stamp start = Stamp::from_seconds(12.5);
  EXPECT_DOUBLE_EQ(start.after(0.040).since(start), 0.040);
  EXPECT_DOUBLE_EQ(start.since(start.after(0.040)), -0.040);
}

TEST(Stamp, DifferencesStayExactLongAfterStart) {
  const Stamp late = Stamp::from_seconds(1e6);
  EXPECT_EQ(late.after(1e-9).since(late), 1e-9);
}

TEST(Stamp, LaterIsGreater) {
  EXPECT_LT(Stamp::from_seconds(1.0), Stamp::from_seconds(1.001));
  EXPECT_EQ(Stamp{}, Stamp::from_seconds(0.0));
}

}  // namespace
}  // namespace hopscotch::core
