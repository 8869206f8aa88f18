#include "apps/campaign/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/campaign/factor.hpp"

namespace hopscotch::apps::campaign {
namespace {

TEST(Wilson, AgreesWithPublishedValues) {
  // Newcombe 1998, table I: 81 of 263 and 15 of 148.
  EXPECT_NEAR(wilson95(81, 263).low, 0.2553, 1e-4);
  EXPECT_NEAR(wilson95(81, 263).high, 0.3662, 1e-4);
  EXPECT_NEAR(wilson95(15, 148).low, 0.0624, 1e-4);
  EXPECT_NEAR(wilson95(15, 148).high, 0.1605, 1e-4);
}

TEST(Wilson, StaysInsideZeroAndOne) {
  EXPECT_EQ(wilson95(0, 20).low, 0.0);
  EXPECT_NEAR(wilson95(0, 20).high, 0.1611, 1e-4);
  EXPECT_EQ(wilson95(20, 20).high, 1.0);
  EXPECT_EQ(wilson95(0, 0).low, 0.0);
  EXPECT_EQ(wilson95(0, 0).high, 1.0);
}

TEST(PairedComparison, AgreesWithNewcombesPaper) {
  // Newcombe 1998 (paired), table III: 36, 12, 2, 0 of 50 -> method 10: 0.0569 to 0.3404.
  const PairedDifference result =
      compare_paired({.both = 36, .only_a = 12, .only_b = 2, .neither = 0});
  EXPECT_NEAR(result.difference, 0.20, 1e-12);
  EXPECT_NEAR(result.interval95.low, 0.0569, 2e-3);
  EXPECT_NEAR(result.interval95.high, 0.3404, 2e-3);
  // Two-sided sign test of 2 in 14: 2 * (1 + 14 + 91) / 2^14.
  EXPECT_NEAR(result.p_value, 2.0 * 106.0 / 16384.0, 1e-12);
}

TEST(PairedComparison, EqualCampaignsDifferByNothing) {
  const PairedDifference result =
      compare_paired({.both = 90, .only_a = 0, .only_b = 0, .neither = 10});
  EXPECT_EQ(result.difference, 0.0);
  EXPECT_EQ(result.p_value, 1.0);
  // The intervals of the two rates are skew, so even full agreement leaves a little.
  EXPECT_GE(result.interval95.high, 0.0);
  EXPECT_LT(result.interval95.high, 0.03);
  EXPECT_NEAR(result.interval95.low, -result.interval95.high, 1e-9);
}

TEST(PairedComparison, ManyPairsDoNotOverflow) {
  const PairedDifference result =
      compare_paired({.both = 900'000, .only_a = 60'000, .only_b = 40'000, .neither = 0});
  EXPECT_NEAR(result.difference, 0.02, 1e-12);
  EXPECT_LT(result.interval95.low, 0.02);
  EXPECT_GT(result.interval95.low, 0.018);
  EXPECT_GE(result.p_value, 0.0);
  EXPECT_LT(result.p_value, 1e-6);
}

TEST(ChiSquared, TailAgreesWithTables) {
  EXPECT_NEAR(chi_squared_tail(3.841459, 1), 0.05, 1e-6);
  EXPECT_NEAR(chi_squared_tail(14.067140, 7), 0.05, 1e-6);
  EXPECT_NEAR(chi_squared_tail(24.321886, 7), 0.001, 1e-7);
  EXPECT_EQ(chi_squared_tail(0.0, 3), 1.0);
}

struct Sample {
  std::vector<double> cause, other;
  std::vector<char> succeeded;
};

/// Trials that fail whenever `cause` is below a quarter.
Sample sample_of(int trials) {
  Sample sample;
  for (int k = 0; k < trials; ++k) {
    sample.cause.push_back(common_draw(7, "cause", k, 0));
    sample.other.push_back(common_draw(7, "other", k, 0));
    sample.succeeded.push_back(sample.cause.back() >= 0.25 ? 1 : 0);
  }
  return sample;
}

TEST(Explain, FindsTheFactorThatDecides) {
  const Sample sample = sample_of(2000);
  const Explanation cause = explain(sample.cause, sample.succeeded);
  const Explanation other = explain(sample.other, sample.succeeded);
  EXPECT_GT(cause.share, 0.9);  // a bin boundary lies near, not at, the threshold
  EXPECT_LT(cause.p_value, 1e-9);
  EXPECT_LT(std::abs(other.share), 0.01);
  EXPECT_GT(other.p_value, 1e-3);
}

TEST(Explain, SaysNothingWhereNothingFails) {
  const Explanation result = explain({1.0, 2.0, 3.0}, {1, 1, 1});
  EXPECT_EQ(result.share, 0.0);
  EXPECT_EQ(result.p_value, 1.0);
}

TEST(Moments, AgreeWithTheTextbook) {
  Moments moments;
  for (const double value : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) moments.add(value);
  moments.add(std::nan(""));  // what was not measured does not count
  EXPECT_EQ(moments.count(), 8);
  EXPECT_NEAR(moments.mean(), 5.0, 1e-12);
  EXPECT_NEAR(moments.deviation(), std::sqrt(32.0 / 7.0), 1e-12);
}

TEST(Quantiles, AreByNearestRankAndLeaveOutWhatWasNotMeasured) {
  std::vector<double> values{std::nan("")};
  for (int i = 20; i >= 1; --i) values.push_back(i);
  const Quantiles quantiles = quantiles_of(values);
  EXPECT_EQ(quantiles.p5, 1.0);
  EXPECT_EQ(quantiles.p25, 5.0);
  EXPECT_EQ(quantiles.p50, 10.0);
  EXPECT_EQ(quantiles.p75, 15.0);
  EXPECT_EQ(quantiles.p95, 19.0);
  EXPECT_EQ(quantiles_of({3.0}).p5, 3.0);
  EXPECT_TRUE(std::isnan(quantiles_of({std::nan("")}).p50));
}

TEST(Bins, HoldAboutEqualCountsAndKeepEqualValuesTogether) {
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) values.push_back(i);
  const std::vector<double> boundaries = bin_boundaries(values, 4);
  ASSERT_EQ(boundaries.size(), 4U);
  EXPECT_EQ(bin_of(boundaries, 0.0), 0U);
  EXPECT_EQ(bin_of(boundaries, 24.0), 0U);
  EXPECT_EQ(bin_of(boundaries, 25.0), 1U);
  EXPECT_EQ(bin_of(boundaries, 99.0), 3U);
  const std::vector<double> few = bin_boundaries({1.0, 1.0, 2.0, 2.0, 2.0}, 8);
  EXPECT_EQ(few, (std::vector<double>{1.0, 2.0}));
}

}  // namespace
}  // namespace hopscotch::apps::campaign
