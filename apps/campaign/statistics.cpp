#include "apps/campaign/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hopscotch::apps::campaign {

namespace {

constexpr double kZ = 1.959963984540054;  // two-sided 95 % of the normal distribution
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Two-sided binomial test of one half, by the smaller tail doubled.
double sign_test(std::int64_t a, std::int64_t b) {
  const std::int64_t n = a + b;
  if (n == 0) return 1.0;
  const auto size = static_cast<double>(n);
  double tail = 0.0;
  for (std::int64_t k = 0; k <= std::min(a, b); ++k) {
    const auto x = static_cast<double>(k);
    tail += std::exp(std::lgamma(size + 1.0) - std::lgamma(x + 1.0) - std::lgamma(size - x + 1.0) -
                     size * std::log(2.0));
  }
  return std::min(1.0, 2.0 * tail);
}

/// Regularised upper incomplete gamma function Q(a, x): series below, continued fraction above.
double gamma_tail(double a, double x) {
  constexpr int kMost = 1000;
  constexpr double kTolerance = 1e-14;
  if (x <= 0.0) return 1.0;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (int n = 1; n < kMost && term > sum * kTolerance; ++n) sum += term *= x / (a + n);
    return std::max(0.0, 1.0 - scale * sum);
  }
  constexpr double kTiny = 1e-300;
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double fraction = d;
  for (int n = 1; n < kMost; ++n) {
    const double an = -n * (n - a);
    b += 2.0;
    d = 1.0 / (std::abs(an * d + b) < kTiny ? kTiny : an * d + b);
    c = std::abs(b + an / c) < kTiny ? kTiny : b + an / c;
    fraction *= d * c;
    if (std::abs(d * c - 1.0) < kTolerance) break;
  }
  return scale * fraction;
}

struct BinCounts {
  std::vector<double> trials;
  std::vector<double> successes;
};

}  // namespace

Interval wilson95(std::int64_t successes, std::int64_t trials) {
  if (trials <= 0) return {};
  const auto n = static_cast<double>(trials);
  const double p = static_cast<double>(successes) / n;
  const double d = 1.0 + kZ * kZ / n;
  const double centre = (p + kZ * kZ / (2.0 * n)) / d;
  const double half = kZ * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n)) / d;
  // At none or all successes the end is exactly 0 or 1; rounding must not say otherwise.
  return {successes == 0 ? 0.0 : std::max(0.0, centre - half),
          successes == trials ? 1.0 : std::min(1.0, centre + half)};
}

PairedDifference compare_paired(const PairedCounts& counts) {
  PairedDifference result;
  const auto n = static_cast<double>(counts.total());
  if (counts.total() == 0) {
    result.interval95 = {-1.0, 1.0};
    return result;
  }
  const std::int64_t a_count = counts.both + counts.only_a;
  const std::int64_t b_count = counts.both + counts.only_b;
  const double a = static_cast<double>(a_count) / n;
  const double b = static_cast<double>(b_count) / n;
  const Interval wa = wilson95(a_count, counts.total());
  const Interval wb = wilson95(b_count, counts.total());
  const double product = a * (1.0 - a) * b * (1.0 - b) * n * n * n * n;
  const double covariance = static_cast<double>(counts.both) * static_cast<double>(counts.neither) -
                            static_cast<double>(counts.only_a) * static_cast<double>(counts.only_b);
  const double phi = product > 0.0 ? covariance / std::sqrt(product) : 0.0;
  const auto spread = [phi](double x, double y) {
    return std::sqrt(std::max(0.0, x * x - 2.0 * phi * x * y + y * y));
  };
  result.difference = a - b;
  result.interval95 = {result.difference - spread(a - wa.low, wb.high - b),
                       result.difference + spread(wa.high - a, b - wb.low)};
  result.p_value = sign_test(counts.only_a, counts.only_b);
  return result;
}

double chi_squared_tail(double x, int degrees) {
  return degrees <= 0 ? 1.0 : gamma_tail(0.5 * degrees, 0.5 * x);
}

void Moments::add(double value) {
  if (std::isnan(value)) return;
  ++count_;
  const double before = value - mean_;
  mean_ += before / static_cast<double>(count_);
  squares_ += before * (value - mean_);
}

double Moments::mean() const {
  return count_ > 0 ? mean_ : kNaN;
}

double Moments::deviation() const {
  return count_ > 1 ? std::sqrt(squares_ / static_cast<double>(count_ - 1)) : kNaN;
}

Quantiles quantiles_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return {kNaN, kNaN, kNaN, kNaN, kNaN};
  std::sort(values.begin(), values.end());
  const auto rank = [&](double share) {
    const double n = std::ceil(share * static_cast<double>(values.size()));
    return values[static_cast<std::size_t>(std::max(n - 1.0, 0.0))];
  };
  return {rank(0.05), rank(0.25), rank(0.50), rank(0.75), rank(0.95)};
}

std::vector<double> bin_boundaries(std::vector<double> values, int bins) {
  std::sort(values.begin(), values.end());
  std::vector<double> distinct = values;
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  if (distinct.size() <= static_cast<std::size_t>(bins)) return distinct;
  std::vector<double> boundaries;
  for (int i = 1; i <= bins; ++i) {
    const std::size_t rank =
        values.size() * static_cast<std::size_t>(i) / static_cast<std::size_t>(bins);
    const double boundary = values[std::max<std::size_t>(rank, 1) - 1];
    if (boundaries.empty() || boundary > boundaries.back()) boundaries.push_back(boundary);
  }
  return boundaries;
}

std::size_t bin_of(const std::vector<double>& boundaries, double value) {
  const auto bin = std::lower_bound(boundaries.begin(), boundaries.end(), value);
  return static_cast<std::size_t>(std::min(bin, boundaries.end() - 1) - boundaries.begin());
}

namespace {

BinCounts count_bins(const std::vector<double>& values, const std::vector<char>& succeeded,
                     const std::vector<double>& boundaries) {
  BinCounts counts{std::vector<double>(boundaries.size(), 0.0),
                   std::vector<double>(boundaries.size(), 0.0)};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    const std::size_t bin = bin_of(boundaries, values[i]);
    counts.trials[bin] += 1.0;
    counts.successes[bin] += succeeded[i] != 0 ? 1.0 : 0.0;
  }
  return counts;
}

}  // namespace

Explanation explain(const std::vector<double>& values, const std::vector<char>& succeeded) {
  std::vector<double> numbers;
  for (const double value : values) {
    if (!std::isnan(value)) numbers.push_back(value);
  }
  Explanation result;
  if (numbers.size() < 2) return result;
  const std::vector<double> boundaries = bin_boundaries(numbers, kExplainBins);
  const BinCounts counts = count_bins(values, succeeded, boundaries);
  double n = 0.0;
  double successes = 0.0;
  for (std::size_t i = 0; i < boundaries.size(); ++i) {
    n += counts.trials[i];
    successes += counts.successes[i];
  }
  const double p = successes / n;
  const double variance = p * (1.0 - p);
  result.bins = static_cast<int>(boundaries.size());
  const double groups = static_cast<double>(boundaries.size());
  if (variance <= 0.0 || boundaries.size() < 2 || n <= groups) return result;
  double between = 0.0;
  for (std::size_t i = 0; i < boundaries.size(); ++i) {
    const double off = counts.successes[i] / counts.trials[i] - p;
    between += counts.trials[i] * off * off;
  }
  const double total = n * variance;
  const double within = (total - between) / (n - groups);
  result.share = (between - (groups - 1.0) * within) / (total + within);
  result.p_value = chi_squared_tail(between / variance, result.bins - 1);
  return result;
}

}  // namespace hopscotch::apps::campaign
