#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hopscotch::core {

/// A file that a person wrote says something it must not. The text names file, line, key, value,
/// rule.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Closed or open range of a number; the text of a breach shows it as mathematics.
struct Range {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool lowest_allowed = true;
  bool highest_allowed = true;

  static constexpr Range any() { return {}; }
  static constexpr Range positive() { return {.lowest = 0.0, .lowest_allowed = false}; }
  static constexpr Range not_negative() { return {.lowest = 0.0}; }
  static constexpr Range closed(double lowest, double highest) {
    return {.lowest = lowest, .highest = highest};
  }
  /// lowest < x <= highest
  static constexpr Range above(double lowest, double highest) {
    return {.lowest = lowest, .highest = highest, .lowest_allowed = false};
  }
};

/// Strict access to one mapping of a YAML file. Every key must be read, every read key must be
/// there (unless a documented default is passed), every value must have its type and lie in its
/// range: anything else throws ConfigError. Call `finish()` after the last read of a mapping: it
/// rejects keys that nothing asked for. Copies share the record of what was read.
class ConfigReader {
 public:
  /// @throws ConfigError if the file is missing, is no YAML or its root is no mapping.
  static ConfigReader from_file(const std::filesystem::path& file);
  /// The same from memory; `name` stands for the file in messages.
  static ConfigReader from_text(std::string_view text, std::string name);

  [[nodiscard]] bool has(std::string_view key) const;

  [[nodiscard]] double number(std::string_view key, Range range = Range::any()) const;
  [[nodiscard]] double number_or(std::string_view key, double fallback,
                                 Range range = Range::any()) const;
  [[nodiscard]] int integer(std::string_view key, int lowest, int highest) const;
  [[nodiscard]] int integer_or(std::string_view key, int fallback, int lowest, int highest) const;
  [[nodiscard]] bool flag(std::string_view key) const;
  [[nodiscard]] std::string text(std::string_view key) const;
  [[nodiscard]] std::string text_or(std::string_view key, std::string fallback) const;
  /// One of `choices`, as its position there.
  [[nodiscard]] int choice(std::string_view key, const std::vector<std::string>& choices) const;
  /// A sequence of exactly `size` numbers.
  [[nodiscard]] Eigen::VectorXd numbers(std::string_view key, int size,
                                        Range range = Range::any()) const;
  template <int N>
  [[nodiscard]] Eigen::Vector<double, N> vector(std::string_view key,
                                                Range range = Range::any()) const {
    return numbers(key, N, range);
  }
  /// A sequence of numbers of any length from 1.
  [[nodiscard]] std::vector<double> number_list(std::string_view key,
                                                Range range = Range::any()) const;

  /// A nested mapping.
  [[nodiscard]] ConfigReader section(std::string_view key) const;
  [[nodiscard]] std::optional<ConfigReader> section_if(std::string_view key) const;
  /// A sequence of mappings.
  [[nodiscard]] std::vector<ConfigReader> list(std::string_view key) const;
  [[nodiscard]] std::vector<ConfigReader> list_if(std::string_view key) const;
  /// Keys of this mapping in the order of the file.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// @throws ConfigError naming the first key of this mapping that was never read.
  void finish() const;

  /// Throws a ConfigError for `key` with the caller's own rule, e.g. "must not overlap slab 2".
  [[noreturn]] void reject(std::string_view key, std::string_view rule) const;

  /// "file:line" of this mapping.
  [[nodiscard]] std::string place() const;

 private:
  struct Node;
  explicit ConfigReader(std::shared_ptr<Node> node);
  std::shared_ptr<Node> node_;  // shared, since copies must share the record of what was read
};

}  // namespace hopscotch::core
