#include "apps/html.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hopscotch::apps {
namespace {

TEST(Html, MarkupInTextIsHarmless) {
  EXPECT_EQ(escape("a<b> & \"c\" 'd'\n"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39; ");
}

TEST(Html, NumbersHaveFixedDecimalsAndNoMinusZero) {
  EXPECT_EQ(fixed(1.25, 1), "1.2");  // exactly between two: to even
  EXPECT_EQ(fixed(-0.04, 1), "0.0");
  EXPECT_EQ(fixed(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed(12345.6, 0), "12346");
}

TEST(Html, WhatIsNoNumberIsADash) {
  EXPECT_EQ(fixed(std::nan(""), 2), "–");
  EXPECT_EQ(fixed(std::numeric_limits<double>::infinity(), 2), "–");
  EXPECT_EQ(fixed(1e300, 2), "–");
}

TEST(Html, PathIsInterruptedWherePointsAreMissing) {
  const double nan = std::nan("");
  const std::vector<Eigen::Vector2d> points{{0, 0}, {1, 2}, {nan, 0}, {3, 4}, {5, 6}};
  EXPECT_EQ(path_data(points), "M0.0 0.0L1.0 2.0M3.0 4.0L5.0 6.0");
}

TEST(Html, DecimationKeepsPeaksEndsAndGaps) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(i, 0.0);
  points[333].y() = 7.0;
  points[777].y() = -7.0;
  points[500].y() = std::nan("");
  const std::vector<Eigen::Vector2d> few = decimate(points, 20);
  EXPECT_LT(few.size(), 70U);
  double highest = 0.0;
  double lowest = 0.0;
  int gaps = 0;
  double previous = -1.0;
  for (const Eigen::Vector2d& p : few) {
    EXPECT_GE(p.x(), previous);
    previous = p.x();
    if (!p.allFinite()) {
      ++gaps;
      continue;
    }
    highest = std::max(highest, p.y());
    lowest = std::min(lowest, p.y());
  }
  EXPECT_EQ(highest, 7.0);
  EXPECT_EQ(lowest, -7.0);
  EXPECT_EQ(gaps, 1);
}

TEST(Html, ShortSeriesAreNotDecimated) {
  const std::vector<Eigen::Vector2d> points{{0, 0}, {1, 1}, {2, 0}};
  EXPECT_EQ(decimate(points, 5), points);
}

TEST(Html, TicksAreRoundAndFew) {
  EXPECT_EQ(axis_ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_TRUE(axis_ticks(1.0, 1.0, 5).empty());
  EXPECT_TRUE(axis_ticks(0.0, std::nan(""), 5).empty());
  for (const double span : {0.013, 0.7, 3.3, 99.0, 12345.0}) {
    const std::vector<double> ticks = axis_ticks(-0.3 * span, 0.7 * span, 6);
    EXPECT_GE(ticks.size(), 2U) << span;
    EXPECT_LE(ticks.size(), 7U) << span;
  }
}

TEST(Html, TickDecimalsTellNeighboursApart) {
  EXPECT_EQ(tick_decimals({0.0, 0.5, 1.0}), 1);
  EXPECT_EQ(tick_decimals({0.0, 200.0}), 0);
  EXPECT_EQ(tick_decimals({0.0, 0.02}), 2);
}

TEST(Html, Base64OfKnownBytes) {
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  };
  // RFC 4648, section 10
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace hopscotch::apps
