#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hopscotch::apps::campaign {

struct Interval {
  double low = 0.0;
  double high = 1.0;
  [[nodiscard]] double half_width() const { return 0.5 * (high - low); }
};

/// 95 % score interval of Wilson for a success rate; [0, 1] without trials.
[[nodiscard]] Interval wilson95(std::int64_t successes, std::int64_t trials);

/// Two campaigns on the same draws, trial by trial.
struct PairedCounts {
  std::int64_t both = 0;    ///< Succeeded in both.
  std::int64_t only_a = 0;  ///< Succeeded in the first only.
  std::int64_t only_b = 0;
  std::int64_t neither = 0;
  [[nodiscard]] std::int64_t total() const { return both + only_a + only_b + neither; }
};

struct PairedDifference {
  double difference = 0.0;  ///< Rate of the first minus rate of the second.
  Interval interval95;      ///< Of the difference, by Newcombe's method 10 for paired rates.
  double p_value = 1.0;     ///< McNemar's exact test of "no difference", two-sided.
};
[[nodiscard]] PairedDifference compare_paired(const PairedCounts& counts);

/// Whether a factor explains which trials succeed.
struct Explanation {
  std::string factor;
  double share = 0.0;    ///< Of the outcome's variance between the factor's bins, corrected for
                         ///< chance (omega squared); may be below 0 when there is nothing.
  double p_value = 1.0;  ///< Chi-squared test of independence.
  int bins = 0;
};
/// @param values    Of the factor in each trial; trials where it is not a number are left out.
/// @param succeeded Of each trial.
/// Values fall into at most `kExplainBins` bins of about equal counts; a grid keeps its levels.
inline constexpr int kExplainBins = 8;
[[nodiscard]] Explanation explain(const std::vector<double>& values,
                                  const std::vector<char>& succeeded);

/// Probability that a chi-squared variable exceeds x.
[[nodiscard]] double chi_squared_tail(double x, int degrees);

/// How values lie about their middle: 5, 25, 50, 75 and 95 % of them are not larger, by nearest
/// rank; NaN without values. Values that are not a number are left out.
struct Quantiles {
  double p5 = 0.0;
  double p25 = 0.0;
  double p50 = 0.0;
  double p75 = 0.0;
  double p95 = 0.0;
};
[[nodiscard]] Quantiles quantiles_of(std::vector<double> values);

/// Mean, standard deviation (n - 1) and count, added up one by one (Welford).
class Moments {
 public:
  void add(double value);
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] double mean() const;       ///< NaN without values.
  [[nodiscard]] double deviation() const;  ///< NaN below two values.

 private:
  std::int64_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

/// Boundaries that part values into at most `bins` groups of about equal counts; a value belongs
/// to the group of the first boundary that it does not exceed. Equal values stay together.
[[nodiscard]] std::vector<double> bin_boundaries(std::vector<double> values, int bins);
[[nodiscard]] std::size_t bin_of(const std::vector<double>& boundaries, double value);

}  // namespace hopscotch::apps::campaign
