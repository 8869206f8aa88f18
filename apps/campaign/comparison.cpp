#include "apps/campaign/comparison.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "apps/campaign/analysis.hpp"
#include "apps/campaign/spec.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps::campaign {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kExamples = 5;

/// The tally that a pair of outcomes belongs to.
std::int64_t& tally_of(PairedCounts& counts, const TrialResult& a, const TrialResult& b) {
  if (a.succeeded()) return b.succeeded() ? counts.both : counts.only_a;
  return b.succeeded() ? counts.only_b : counts.neither;
}

void add_counts(Json& json, const PairedCounts& counts) {
  const PairedDifference difference = compare_paired(counts);
  json["pairs"] = counts.total();
  json["both"] = counts.both;
  json["only_first"] = counts.only_a;
  json["only_second"] = counts.only_b;
  json["neither"] = counts.neither;
  json["difference"] = difference.difference;
  json["interval95"] = {difference.interval95.low, difference.interval95.high};
  json["p_value"] = difference.p_value;
}

}  // namespace

Comparison compare(const Store& a, const Store& b) {
  if (a.identity().pairing != b.identity().pairing) {
    throw core::ConfigError("\"" + b.identity().name + "\" cannot be compared with \"" +
                            a.identity().name +
                            "\": scenario, vary or seed differ, so that no trials pair");
  }
  Comparison comparison;
  comparison.name_a = a.identity().name;
  comparison.name_b = b.identity().name;
  comparison.program_a = a.identity().program;
  comparison.program_b = b.identity().program;
  comparison.cells.resize(static_cast<std::size_t>(a.identity().cells));
  std::unordered_map<std::int64_t, TrialResult> theirs;
  b.for_each(Store::Paths::without, [&](const TrialResult& row) {
    TrialResult& kept = theirs[row.index];  // the outcome is all that is needed
    kept.outcome = row.outcome;
    kept.truth_outcome = row.truth_outcome;
  });
  a.for_each(Store::Paths::without, [&](const TrialResult& row) {
    const auto other = theirs.find(row.index);
    if (other == theirs.end()) return;
    const TrialPlace place = place_of(row.index, a.identity().cells);
    ++tally_of(comparison.total, row, other->second);
    ++tally_of(comparison.cells[static_cast<std::size_t>(place.cell)], row, other->second);
    const bool ours = row.succeeded();
    if (ours == other->second.succeeded()) return;
    std::vector<std::int64_t>& examples = ours ? comparison.only_a : comparison.only_b;
    if (examples.size() < kExamples) examples.push_back(row.index);
  });
  return comparison;
}

std::string comparison_json(const Comparison& comparison, const std::vector<Factor>& factors) {
  Json json{{"schema", "hopscotch.comparison/1"},
            {"first", comparison.name_a},
            {"second", comparison.name_b},
            {"program_first", comparison.program_a},
            {"program_second", comparison.program_b}};
  add_counts(json, comparison.total);
  json["only_first_trials"] = comparison.only_a;
  json["only_second_trials"] = comparison.only_b;
  json["cells"] = Json::array();
  for (std::size_t i = 0; i < comparison.cells.size(); ++i) {
    Json cell = Json::object();
    const std::vector<std::size_t> levels = levels_of(factors, static_cast<std::int64_t>(i));
    for (std::size_t f = 0; f < factors.size(); ++f) {
      if (factors[f].kind != Factor::Kind::grid) continue;
      cell[factors[f].name] = level_label(factors[f], levels[f]);
    }
    add_counts(cell, comparison.cells[i]);
    json["cells"].push_back(std::move(cell));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hopscotch::apps::campaign
