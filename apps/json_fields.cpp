#include "apps/json_fields.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

using Json = JsonFields::Json;

/// As a message shows it.
std::string shown(const Json& value) {
  constexpr std::size_t kMost = 60;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

Json parsed(std::string_view text, const std::string& name) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = 1 + std::count(text.begin(), end, '\n');
    throw core::ConfigError(name + ":" + std::to_string(line) +
                            (text.empty() ? ": is empty" : ": is no JSON, or is cut short"));
  }
}

}  // namespace

JsonFields JsonFields::parse(std::string_view text, const std::string& name) {
  Json json = parsed(text, name);
  if (!json.is_object()) throw core::ConfigError(name + ": must be a JSON object");
  return {std::move(json), name, ""};
}

JsonFields::JsonFields(Json json, std::string file, std::string path)
    : json_(std::move(json)), file_(std::move(file)), path_(std::move(path)) {}

void JsonFields::reject(const char* key, std::string_view rule) const {
  const std::string value = has(key) ? " = " + shown(json_.at(key)) + ", but" : "";
  throw core::ConfigError(file_ + ": " + path_ + key + value + " " + std::string(rule));
}

const Json& JsonFields::at(const char* key) const {
  if (!has(key)) reject(key, "is missing");
  return json_.at(key);
}

std::string JsonFields::text(const char* key) const {
  if (!at(key).is_string()) reject(key, "must be a text");
  return at(key).get<std::string>();
}

double JsonFields::number(const char* key) const {
  if (at(key).is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!at(key).is_number()) reject(key, "must be a number or null");
  return at(key).get<double>();
}

int JsonFields::count(const char* key) const {
  const std::uint64_t value = seed(key);
  if (value > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
    reject(key, "is too large");
  }
  return static_cast<int>(value);
}

std::uint64_t JsonFields::seed(const char* key) const {
  if (!at(key).is_number_unsigned()) reject(key, "must be a whole number from 0 on");
  return at(key).get<std::uint64_t>();
}

bool JsonFields::flag(const char* key) const {
  if (!at(key).is_boolean()) reject(key, "must be true or false");
  return at(key).get<bool>();
}

JsonFields JsonFields::object(const char* key) const {
  if (!at(key).is_object()) reject(key, "must be an object");
  return {at(key), file_, path_ + key + "."};
}

std::vector<JsonFields> JsonFields::list(const char* key) const {
  if (!at(key).is_array()) reject(key, "must be a list of objects");
  std::vector<JsonFields> items;
  for (const Json& item : at(key)) {
    if (!item.is_object()) reject(key, "must be a list of objects");
    items.push_back({item, file_, path_ + key + "[" + std::to_string(items.size()) + "]."});
  }
  return items;
}

}  // namespace hopscotch::apps
