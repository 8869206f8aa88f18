#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hopscotch::apps {

/// Strict access to one object of a JSON file. What is missing or of another kind than asked for
/// throws core::ConfigError with file, key, value and rule.
class JsonFields {
 public:
  using Json = nlohmann::ordered_json;

  /// @param name Stands for the file in messages.
  /// @throws core::ConfigError with the line if `text` is no JSON or no object.
  static JsonFields parse(std::string_view text, const std::string& name);

  [[nodiscard]] bool has(const char* key) const { return json_.contains(key); }
  [[nodiscard]] std::string text(const char* key) const;
  /// null is NaN.
  [[nodiscard]] double number(const char* key) const;
  [[nodiscard]] int count(const char* key) const;
  [[nodiscard]] std::uint64_t seed(const char* key) const;
  [[nodiscard]] bool flag(const char* key) const;
  [[nodiscard]] JsonFields object(const char* key) const;
  [[nodiscard]] std::vector<JsonFields> list(const char* key) const;

  /// Throws for `key` with the caller's own rule.
  [[noreturn]] void reject(const char* key, std::string_view rule) const;

 private:
  JsonFields(Json json, std::string file, std::string path);
  [[nodiscard]] const Json& at(const char* key) const;

  Json json_;
  std::string file_;
  std::string path_;  ///< Dotted, with a trailing dot.
};

}  // namespace hopscotch::apps
