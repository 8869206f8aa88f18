#include "apps/campaign/factor.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "sim/random.hpp"

namespace hopscotch::apps::campaign {

using core::ConfigReader;

namespace {

constexpr std::size_t kMostLevels = 1000;
constexpr double kRounding = 1e6;  // draws keep six decimals

std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

bool whole(double value, double step) {
  return step <= 0.0 || std::abs(value - step * std::round(value / step)) < 1e-9;
}

std::string step_rule(const FactorRule& rule) {
  return "must be a whole multiple of " + exact_text(rule.step);
}

/// Position of a word among the rule's choices.
double choice_value(const ConfigReader& reader, std::string_view key, const FactorRule& rule,
                    const std::string& word) {
  const auto found = std::find(rule.choices.begin(), rule.choices.end(), word);
  if (found == rule.choices.end()) {
    std::string text = "must be one of";
    for (const std::string& choice : rule.choices) text += " " + choice;
    reader.reject(key, text);
  }
  return static_cast<double>(found - rule.choices.begin());
}

void read_levels(const FactorSection& section, const FactorRule& rule, Factor& factor) {
  const ConfigReader& grid = section.reader;
  factor.kind = Factor::Kind::grid;
  for (const std::string& key : grid.keys()) {
    if (key != "grid") grid.reject(key, "is not a known key here");
  }
  factor.labels = section.words("grid");
  if (factor.labels.size() > kMostLevels) grid.reject("grid", "must have at most 1000 values");
  if (factor.words) {
    for (const std::string& word : factor.labels) {
      factor.values.push_back(choice_value(grid, "grid", rule, word));
    }
  } else {
    factor.values = grid.number_list("grid", rule.range);
  }
  for (std::size_t i = 0; i < factor.values.size(); ++i) {
    if (!whole(factor.values[i], rule.step)) grid.reject("grid", step_rule(rule));
    const auto begin = factor.values.begin();
    const auto here = begin + static_cast<std::ptrdiff_t>(i);
    if (std::find(begin, here, factor.values[i]) != here) {
      grid.reject("grid", "must not hold a value twice");
    }
  }
}

void read_range(const ConfigReader& reader, const FactorRule& rule, Factor& factor) {
  const std::string key(rule.name);
  if (factor.words) reader.reject(key, "must be one word or {grid: [word, ...]}");
  const Eigen::Vector2d range = reader.vector<2>(key, rule.range);
  if (!(range[0] < range[1])) reader.reject(key, "must rise from its first to its second number");
  for (const double end : {range[0], range[1]}) {
    if (!whole(end, rule.step)) reader.reject(key, step_rule(rule));
  }
  factor.kind = Factor::Kind::uniform;
  factor.lowest = range[0];
  factor.highest = range[1];
}

void read_fixed(const ConfigReader& reader, const FactorRule& rule, Factor& factor) {
  factor.kind = Factor::Kind::fixed;
  factor.labels = {reader.text(rule.name)};
  if (factor.words) {
    factor.values = {choice_value(reader, rule.name, rule, factor.labels[0])};
    return;
  }
  factor.values = {reader.number(rule.name, rule.range)};
  if (!whole(factor.values[0], rule.step)) reader.reject(rule.name, step_rule(rule));
}

}  // namespace

core::ConfigValue FactorSection::value(std::string_view key) const {
  std::vector<std::string> place = path;
  place.emplace_back(key);
  return core::value_at(text, place);
}

FactorSection FactorSection::below(const std::string& key, const std::string& its_prefix) const {
  std::vector<std::string> place = path;
  place.push_back(key);
  return {reader.section(key), text, place, its_prefix};
}

std::vector<std::string> FactorSection::words(const std::string& key) const {
  const core::ConfigValue found = value(key);
  if (found.shape == core::ConfigShape::absent) reader.reject(key, "is missing");
  const bool plain = std::none_of(found.words.begin(), found.words.end(),
                                  [](const std::string& word) { return word.empty(); });
  if (found.words.empty() || !plain) reader.reject(key, "must be a list of plain values");
  return found.words;
}

Factor read_factor(const FactorSection& section, const FactorRule& rule) {
  const std::string key(rule.name);
  Factor factor;
  factor.name = section.prefix + key;
  factor.step = rule.step;
  factor.words = !rule.choices.empty();
  switch (section.value(key).shape) {
    case core::ConfigShape::mapping: read_levels(section.below(key, ""), rule, factor); break;
    case core::ConfigShape::list: read_range(section.reader, rule, factor); break;
    case core::ConfigShape::scalar:
    case core::ConfigShape::absent: read_fixed(section.reader, rule, factor); break;
  }
  return factor;
}

std::vector<std::size_t> levels_of(const std::vector<Factor>& factors, std::int64_t cell) {
  std::vector<std::size_t> levels(factors.size(), 0);
  for (std::size_t i = factors.size(); i-- > 0;) {
    const auto count = static_cast<std::int64_t>(factors[i].levels());
    levels[i] = static_cast<std::size_t>(cell % count);
    cell /= count;
  }
  return levels;
}

double common_draw(std::uint64_t seed, std::string_view factor, std::int64_t repetition,
                   int element) {
  constexpr std::uint64_t kElementsApart = 1ULL << 40;  // more repetitions than anyone runs
  const std::uint64_t place =
      static_cast<std::uint64_t>(repetition) + kElementsApart * static_cast<std::uint64_t>(element);
  sim::Random random = sim::Random::stream(seed ^ fnv1a(factor), place + 1);
  return 0.5 * (random.uniform() + 1.0);
}

double factor_value(const Factor& factor, std::size_t level, const DrawKey& key) {
  if (factor.kind == Factor::Kind::grid) return factor.values.at(level);
  if (factor.kind == Factor::Kind::fixed) return factor.values.at(0);
  const double share = common_draw(key.seed, factor.name, key.repetition, key.element);
  if (factor.step > 0.0) {
    // Every multiple in the range, its ends included, is as likely as any other.
    const double count = std::round((factor.highest - factor.lowest) / factor.step) + 1.0;
    return factor.lowest + factor.step * std::floor(share * count);
  }
  const double value = factor.lowest + share * (factor.highest - factor.lowest);
  return std::clamp(std::round(value * kRounding) / kRounding, factor.lowest, factor.highest);
}

std::string hex_text(std::uint64_t id) {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(id));
  return digits.data();
}

std::string fingerprint(std::string_view text) {
  return hex_text(fnv1a(text));
}

std::string exact_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string canonical(const Factor& factor) {
  std::string text = factor.name;
  switch (factor.kind) {
    case Factor::Kind::uniform:
      return text + " uniform " + exact_text(factor.lowest) + " " + exact_text(factor.highest);
    case Factor::Kind::fixed: text += " fixed"; break;
    case Factor::Kind::grid: text += " grid"; break;
  }
  for (const double value : factor.values) text += " " + exact_text(value);
  return text;
}

}  // namespace hopscotch::apps::campaign
