#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/config_reader.hpp"
#include "core/config_shape.hpp"

namespace hopscotch::apps::campaign {

/// What values a factor may take, and how they are written.
struct FactorRule {
  std::string_view name;
  core::Range range = core::Range::any();  ///< Of a number.
  std::vector<std::string> choices = {};   ///< Not empty: one of these words; its value is the
                                           ///< position among them.
  double step = 0.0;                       ///< Above 0: whole multiples of it only.
};

/// A quantity in which trials differ: fixed, drawn anew for each trial, or one cell per value.
struct Factor {
  enum class Kind : std::uint8_t { fixed, uniform, grid };

  std::string name;  ///< Dotted path in the file, e.g. "push.impulse_Ns".
  Kind kind = Kind::fixed;
  double lowest = 0.0;              ///< Of a uniform draw.
  double highest = 0.0;             ///< Of a uniform draw.
  double step = 0.0;                ///< Draws are whole multiples of it; 0: any number.
  std::vector<double> values;       ///< Of the levels: one if fixed, at least one in a grid.
  std::vector<std::string> labels;  ///< The levels as the file writes them.
  bool words = false;               ///< The levels are words, not numbers.

  [[nodiscard]] std::size_t levels() const { return kind == Kind::grid ? values.size() : 1; }
};

/// A mapping of a campaign file that holds factors.
struct FactorSection {
  core::ConfigReader reader;
  std::string text;               ///< Of the whole file.
  std::vector<std::string> path;  ///< Keys from the root to the mapping.
  std::string prefix;             ///< Stands before a key in its factor's name.

  [[nodiscard]] core::ConfigValue value(std::string_view key) const;
  /// The mapping at a key.
  [[nodiscard]] FactorSection below(const std::string& key, const std::string& its_prefix) const;
  /// The words of the list at a key, which must be a list of plain values.
  [[nodiscard]] std::vector<std::string> words(const std::string& key) const;
};

/// Reads a key: a plain value, `[lowest, highest]` or `{grid: [value, ...]}`.
/// @throws core::ConfigError with file, line, key, value and rule.
[[nodiscard]] Factor read_factor(const FactorSection& section, const FactorRule& rule);

/// Level of every factor in a cell of their grid; the last factor changes fastest.
[[nodiscard]] std::vector<std::size_t> levels_of(const std::vector<Factor>& factors,
                                                 std::int64_t cell);

/// The same draw for the same arguments on every machine, uniform in [0, 1). Each factor has its
/// own stream over the repetitions, so that cells and ablations share their draws and a new factor
/// shifts none of the others.
/// @param element Numbers the draws within one trial, e.g. the treads of a terrain.
[[nodiscard]] double common_draw(std::uint64_t seed, std::string_view factor,
                                 std::int64_t repetition, int element);

/// Value of a factor in a trial: its level in the trial's cell, or its draw, rounded to 1e-6 so
/// that it can be written down exactly.
struct DrawKey {
  std::uint64_t seed = 1;
  std::int64_t repetition = 0;
  int element = 0;
};
[[nodiscard]] double factor_value(const Factor& factor, std::size_t level, const DrawKey& key);

/// Sixteen hexadecimal digits.
[[nodiscard]] std::string hex_text(std::uint64_t id);
/// 64 bits that identify a text (FNV-1a), as `hex_text`.
[[nodiscard]] std::string fingerprint(std::string_view text);

/// The factor in one line, the same for the same meaning: part of a campaign's identity.
[[nodiscard]] std::string canonical(const Factor& factor);

/// Shortest text from which the number can be read back exactly.
[[nodiscard]] std::string exact_text(double value);

}  // namespace hopscotch::apps::campaign
