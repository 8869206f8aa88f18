#include "apps/campaign/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace hopscotch::apps::campaign {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kExamples = 5;
constexpr std::size_t kSuccesses = 100;
constexpr std::size_t kCloseCalls = 10;

/// Collects the rows of a store into an analysis.
class Collector {
 public:
  explicit Collector(Analysis& analysis) : analysis_(analysis) {
    const StoreIdentity& identity = analysis.identity;
    analysis_.cells.resize(static_cast<std::size_t>(identity.cells));
    for (std::size_t i = 0; i < analysis_.cells.size(); ++i) {
      analysis_.cells[i].levels = levels_of(identity.factors, static_cast<std::int64_t>(i));
    }
    values_.resize(identity.factors.size());
    pitch_errors_.resize(analysis_.cells.size());
  }

  void add(const TrialResult& trial) {
    const bool ok = trial.succeeded();
    const TrialPlace place = place_of(trial.index, analysis_.identity.cells);
    CellSummary& cell = analysis_.cells[static_cast<std::size_t>(place.cell)];
    count(analysis_.total, ok);
    count(cell.tally, ok);
    if (trial.rightly_refused()) {
      ++analysis_.rightly_refused;
      ++cell.rightly_refused;
    }
    cell.distance.add(trial.distance);
    cell.landing_error.add(trial.landing_error);
    cell.support_margin.add(trial.support_margin);
    cell.jump_time.add(trial.jump_time);
    cell.jump_time_p95.add(trial.jump_time_p95);
    pitch_errors_[static_cast<std::size_t>(place.cell)].push_back(trial.pitch_error);
    succeeded_.push_back(ok ? 1 : 0);
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i].push_back(trial.values[i]);
    if (ok) {
      if (analysis_.successes.size() < kSuccesses) analysis_.successes.push_back(trial.index);
      note_close_call(trial);
    } else {
      const std::string cause = trial.cause.empty() ? trial.outcome : trial.cause;
      ++cell.failures[cause];
      note_failure(cause, trial);
    }
  }

  void finish() {
    for (auto& [cause, failure] : failures_) analysis_.failures.push_back(failure);
    std::stable_sort(
        analysis_.failures.begin(), analysis_.failures.end(),
        [](const FailureClass& a, const FailureClass& b) { return a.count > b.count; });
    for (std::size_t i = 0; i < values_.size(); ++i) finish_factor(i);
    for (std::size_t i = 0; i < pitch_errors_.size(); ++i) {
      analysis_.cells[i].pitch_error = quantiles_of(std::move(pitch_errors_[i]));
    }
    std::stable_sort(analysis_.explanations.begin(), analysis_.explanations.end(),
                     [](const Explanation& a, const Explanation& b) { return a.share > b.share; });
  }

 private:
  static void count(Tally& tally, char ok) {
    ++tally.trials;
    tally.succeeded += ok;
  }

  void note_failure(const std::string& cause, const TrialResult& trial) {
    FailureClass& failure = failures_[cause];
    if (failure.count++ == 0) {
      failure.cause = cause;
      failure.sentence = trial.sentence;
    }
    if (failure.examples.size() < kExamples) failure.examples.push_back(trial.index);
  }

  void note_close_call(const TrialResult& trial) {
    if (std::isnan(trial.support_margin)) return;
    std::vector<CloseCall>& calls = analysis_.close_calls;
    const CloseCall call{trial.index, trial.support_margin, trial.landing_error};
    const auto closer = [](const CloseCall& a, const CloseCall& b) {
      return a.support_margin < b.support_margin;
    };
    calls.insert(std::upper_bound(calls.begin(), calls.end(), call, closer), call);
    if (calls.size() > kCloseCalls) calls.pop_back();
  }

  void finish_factor(std::size_t i) {
    const Factor& factor = analysis_.identity.factors[i];
    analysis_.bins.emplace_back();
    if (factor.kind == Factor::Kind::fixed || factor.levels() < 2) {
      if (factor.kind != Factor::Kind::uniform) return;
    }
    Explanation explanation = explain(values_[i], succeeded_);
    explanation.factor = factor.name;
    analysis_.explanations.push_back(explanation);
    analysis_.bins.back() = bins_of(factor, values_[i]);
  }

  [[nodiscard]] std::vector<FactorBin> bins_of(const Factor& factor,
                                               const std::vector<double>& values) const {
    std::vector<double> boundaries = factor.values;
    std::sort(boundaries.begin(), boundaries.end());
    if (factor.kind == Factor::Kind::uniform) {
      std::vector<double> numbers;
      std::copy_if(values.begin(), values.end(), std::back_inserter(numbers),
                   [](double value) { return !std::isnan(value); });
      if (numbers.empty()) return {};
      boundaries = bin_boundaries(std::move(numbers), kExplainBins);
    }
    std::vector<FactorBin> bins(boundaries.size(), {INFINITY, -INFINITY, {}});
    for (std::size_t t = 0; t < values.size(); ++t) {
      if (std::isnan(values[t])) continue;
      FactorBin& bin = bins[bin_of(boundaries, values[t])];
      bin.low = std::min(bin.low, values[t]);
      bin.high = std::max(bin.high, values[t]);
      count(bin.tally, succeeded_[t]);
    }
    std::erase_if(bins, [](const FactorBin& bin) { return bin.tally.trials == 0; });
    return bins;
  }

  Analysis& analysis_;
  std::vector<std::vector<double>> values_;        // of each factor, trial by trial
  std::vector<std::vector<double>> pitch_errors_;  // of each cell
  std::vector<char> succeeded_;
  std::map<std::string, FailureClass> failures_;
};

/// Six decimals are below any meaning here.
Json number(double value) {
  constexpr double kDecimals = 1e6;
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * kDecimals) / kDecimals;
}

void add_tally(Json& json, const Tally& tally) {
  const Interval interval = tally.interval();
  json["trials"] = tally.trials;
  json["succeeded"] = tally.succeeded;
  json["rate"] = number(tally.rate());
  json["wilson95"] = {number(interval.low), number(interval.high)};
}

Json spread_json(const Moments& moments) {
  return {{"mean", number(moments.mean())},
          {"deviation", number(moments.deviation())},
          {"n", moments.count()}};
}

Json quantiles_json(const Quantiles& quantiles) {
  return {{"p5", number(quantiles.p5)},
          {"p25", number(quantiles.p25)},
          {"p50", number(quantiles.p50)},
          {"p75", number(quantiles.p75)},
          {"p95", number(quantiles.p95)}};
}

Json cell_json(const std::vector<Factor>& factors, const CellSummary& cell) {
  Json json = Json::object();
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (factors[i].kind == Factor::Kind::uniform) continue;
    if (factors[i].words) {
      json[factors[i].name] = level_label(factors[i], cell.levels[i]);
    } else {
      json[factors[i].name] = factors[i].values[cell.levels[i]];
    }
  }
  add_tally(json, cell.tally);
  json["rightly_refused"] = cell.rightly_refused;
  json["failures"] = cell.failures;
  json["distance_m"] = spread_json(cell.distance);
  json["landing_error_m"] = spread_json(cell.landing_error);
  json["support_margin_m"] = spread_json(cell.support_margin);
  json["pitch_error_rad"] = quantiles_json(cell.pitch_error);
  json["jump_time_s"] = {{"mean", number(cell.jump_time.mean())},
                         {"p95", number(cell.jump_time_p95.mean())},
                         {"n", cell.jump_time.count()}};
  return json;
}

}  // namespace

double Tally::rate() const {
  return trials > 0 ? static_cast<double>(succeeded) / static_cast<double>(trials) : 0.0;
}

double Analysis::trials_per_minute() const {
  return elapsed > 0.0 ? 60.0 * static_cast<double>(total.trials) / elapsed : 0.0;
}

Analysis analyse(const Store& store) {
  Analysis analysis;
  analysis.identity = store.identity();
  analysis.engine = store.note("engine");
  analysis.elapsed = store.elapsed();
  Collector collector(analysis);
  store.for_each(Store::Paths::without, [&](const TrialResult& row) { collector.add(row); });
  collector.finish();
  return analysis;
}

std::string level_label(const Factor& factor, std::size_t level) {
  return factor.labels.at(factor.kind == Factor::Kind::grid ? level : 0);
}

std::string summary_json(const Analysis& analysis) {
  Json json{{"schema", "hopscotch.campaign/1"},
            {"name", analysis.identity.name},
            {"program", analysis.identity.program},
            {"identity", analysis.identity.identity}};
  add_tally(json, analysis.total);
  json["rightly_refused"] = analysis.rightly_refused;
  json["failures"] = Json::object();
  for (const FailureClass& failure : analysis.failures) {
    json["failures"][failure.cause] = failure.count;
  }
  json["cells"] = Json::array();
  for (const CellSummary& cell : analysis.cells) {
    json["cells"].push_back(cell_json(analysis.identity.factors, cell));
  }
  json["explained_by"] = Json::array();
  for (const Explanation& explanation : analysis.explanations) {
    json["explained_by"].push_back({{"factor", explanation.factor},
                                    {"share", number(explanation.share)},
                                    {"p_value", number(explanation.p_value)}});
  }
  json["trials_per_minute"] = number(analysis.trials_per_minute());
  json["engine"] = analysis.engine;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hopscotch::apps::campaign
