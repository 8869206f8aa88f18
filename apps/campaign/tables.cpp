#include <cmath>

#include "apps/campaign/campaign_report.hpp"

namespace hopscotch::apps::campaign {

namespace {

/// A number exactly; nothing where there is none.
std::string field(double value) {
  return std::isfinite(value) ? exact_text(value) : "";
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + "\"";
}

std::string value_field(const Factor& factor, double value) {
  if (!factor.words || std::isnan(value)) return field(value);
  for (std::size_t i = 0; i < factor.values.size(); ++i) {
    if (factor.values[i] == value) return factor.labels[i];
  }
  return field(value);
}

std::string level_field(const Factor& factor, std::size_t level) {
  if (factor.kind != Factor::Kind::uniform) return level_label(factor, level);
  return field(factor.lowest) + " to " + field(factor.highest);
}

}  // namespace

std::string trials_csv(const Store& store) {
  const StoreIdentity& identity = store.identity();
  std::string csv = "trial,cell,repetition,seed";
  for (const Factor& factor : identity.factors) csv += "," + factor.name;
  csv += ",succeeded,outcome,truth_outcome,cause,jumps,landed";
  for (const Metric& metric : kMetrics) csv += "," + std::string(metric.name);
  csv += ",sentence\n";
  store.for_each(Store::Paths::without, [&](const TrialResult& row) {
    const TrialPlace place = place_of(row.index, identity.cells);
    csv += std::to_string(row.index) + "," + std::to_string(place.cell) + "," +
           std::to_string(place.repetition) + "," + std::to_string(row.seed);
    for (std::size_t i = 0; i < identity.factors.size(); ++i) {
      csv += "," + value_field(identity.factors[i], row.values[i]);
    }
    csv += std::string(row.succeeded() ? ",1," : ",0,") + row.outcome + "," + row.truth_outcome +
           "," + row.cause + "," + std::to_string(row.jumps) + "," + std::to_string(row.landed);
    for (const Metric& metric : kMetrics) csv += "," + field(row.*metric.value);
    csv += "," + quoted(row.sentence) + "\n";
  });
  return csv;
}

std::string cells_csv(const Analysis& analysis) {
  std::string csv = "cell";
  for (const Factor& factor : analysis.identity.factors) csv += "," + factor.name;
  csv +=
      ",trials,succeeded,rate,wilson95_low,wilson95_high,distance_mean_m,distance_deviation_m,"
      "pitch_error_p50_rad,pitch_error_p95_rad,jump_time_mean_s,jump_time_p95_s\n";
  for (std::size_t i = 0; i < analysis.cells.size(); ++i) {
    const CellSummary& cell = analysis.cells[i];
    const Interval interval = cell.tally.interval();
    csv += std::to_string(i);
    for (std::size_t f = 0; f < analysis.identity.factors.size(); ++f) {
      csv += "," + level_field(analysis.identity.factors[f], cell.levels[f]);
    }
    csv += "," + std::to_string(cell.tally.trials) + "," + std::to_string(cell.tally.succeeded);
    for (const double value :
         {cell.tally.rate(), interval.low, interval.high, cell.distance.mean(),
          cell.distance.deviation(), cell.pitch_error.p50, cell.pitch_error.p95,
          cell.jump_time.mean(), cell.jump_time_p95.mean()}) {
      csv += "," + field(value);
    }
    csv += "\n";
  }
  return csv;
}

}  // namespace hopscotch::apps::campaign
