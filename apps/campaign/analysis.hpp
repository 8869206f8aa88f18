#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "apps/campaign/statistics.hpp"
#include "apps/campaign/store.hpp"

namespace hopscotch::apps::campaign {

/// Trials and how many of them succeeded.
struct Tally {
  std::int64_t trials = 0;
  std::int64_t succeeded = 0;
  [[nodiscard]] double rate() const;  ///< 0 without trials.
  [[nodiscard]] Interval interval() const { return wilson95(succeeded, trials); }
};

struct CellSummary {
  std::vector<std::size_t> levels;  ///< Of every factor.
  Tally tally;
  std::int64_t rightly_refused = 0;              ///< Among the successes.
  std::map<std::string, std::int64_t> failures;  ///< By cause.
  Moments distance;                              ///< Flown by the last jump [m].
  Moments landing_error;                         ///< Largest of a trial [m].
  Moments support_margin;                        ///< Least of a trial [m].
  Moments jump_time;                             ///< Means of trials [s].
  Moments jump_time_p95;                         ///< Of trials [s].
  Quantiles pitch_error;                         ///< Of the largest of each trial [rad].
};

/// Trials that failed for the same first cause.
struct FailureClass {
  std::string cause;
  std::int64_t count = 0;
  std::vector<std::int64_t> examples;  ///< Lowest indices.
  std::string sentence;                ///< Of the first example.
};

/// Success against one factor: bins of about equal counts, or the levels of a grid.
struct FactorBin {
  double low = 0.0;
  double high = 0.0;
  Tally tally;
};

/// A success that was close.
struct CloseCall {
  std::int64_t index = 0;
  double support_margin = 0.0;  ///< [m]
  double landing_error = 0.0;   ///< [m]
};

/// What the rows of a store say.
struct Analysis {
  StoreIdentity identity;
  std::string engine;
  double elapsed = 0.0;  ///< Computing time [s].
  Tally total;
  std::int64_t rightly_refused = 0;
  std::vector<CellSummary> cells;
  std::vector<FailureClass> failures;        ///< Most frequent first.
  std::vector<std::vector<FactorBin>> bins;  ///< Of each factor; empty if it is fixed.
  std::vector<Explanation> explanations;     ///< Of the factors that vary, best first.
  std::vector<CloseCall> close_calls;        ///< Least margin first.
  std::vector<std::int64_t> successes;       ///< The first ones.

  [[nodiscard]] double trials_per_minute() const;
};

/// Reads the whole store once; 56 bytes of memory a trial and 8 more for each factor.
[[nodiscard]] Analysis analyse(const Store& store);

/// What a level of a factor is called; a fixed factor's only one too.
[[nodiscard]] std::string level_label(const Factor& factor, std::size_t level);

/// `summary.json`, schema "hopscotch.campaign/1".
[[nodiscard]] std::string summary_json(const Analysis& analysis);

}  // namespace hopscotch::apps::campaign
