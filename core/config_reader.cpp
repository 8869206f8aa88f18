#include "core/config_reader.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>
#include <utility>

#include "core/config_shape.hpp"
#include "core/input_file.hpp"

namespace hopscotch::core {

struct ConfigReader::Node {
  YAML::Node yaml;
  std::string file;
  std::string path;  // dotted, with a trailing dot, for messages
  mutable std::set<std::string, std::less<>> read;
};

namespace {

std::string at_line(const std::string& file, const YAML::Mark& mark) {
  return mark.is_null() ? file : file + ":" + std::to_string(mark.line + 1);
}

std::string format(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string describe(const Range& range) {
  std::string text;
  if (std::isfinite(range.lowest))
    text += format(range.lowest) + (range.lowest_allowed ? " <= " : " < ");
  text += "x";
  if (std::isfinite(range.highest))
    text += (range.highest_allowed ? " <= " : " < ") + format(range.highest);
  return text;
}

bool inside(double value, const Range& range) {
  const bool above = range.lowest_allowed ? value >= range.lowest : value > range.lowest;
  const bool below = range.highest_allowed ? value <= range.highest : value < range.highest;
  return above && below;
}

void require_unique_keys(const YAML::Node& node, const std::string& file) {
  if (node.IsSequence()) {
    for (const YAML::Node& item : node) require_unique_keys(item, file);
  }
  if (!node.IsMap()) return;
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) {
      throw ConfigError(at_line(file, entry.first.Mark()) + ": keys must be plain words");
    }
    if (!seen.insert(entry.first.Scalar()).second) {
      throw ConfigError(at_line(file, entry.first.Mark()) + ": key '" + entry.first.Scalar() +
                        "' stands here twice");
    }
    require_unique_keys(entry.second, file);
  }
}

/// Rejects anchors and aliases before the tree is built: an alias inside its own anchor makes the
/// tree endless, and nested aliases make it exponentially large.
class AliasRejecter : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { reject(mark, anchor); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override { reject(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& /*value*/) override {
    reject(mark, anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    reject(mark, anchor);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    reject(mark, anchor);
  }
  void OnMapEnd() override {}

 private:
  static void reject(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor != 0) throw YAML::ParserException(mark, "anchors and aliases are not allowed here");
  }
};

void require_one_plain_document(const std::string& text, const std::string& file) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  AliasRejecter rejecter;
  if (parser.HandleNextDocument(rejecter) && parser.HandleNextDocument(rejecter)) {
    throw ConfigError(file + ": holds a second document ('---'), but only one is read");
  }
}

YAML::Node parse_mapping(const std::string& text, const std::string& file) {
  YAML::Node root;
  try {
    require_one_plain_document(text, file);
    root = YAML::Load(text);
    require_unique_keys(root, file);
  } catch (const YAML::Exception& error) {
    throw ConfigError(at_line(file, error.mark) + ": not valid YAML: " + error.msg);
  }
  if (!root.IsMap()) throw ConfigError(file + ":1: must be a mapping of keys to values");
  return root;
}

/// A value as a message shows it, on one line.
std::string shown_value(const YAML::Node& value) {
  if (value.IsScalar()) return value.Scalar();
  if (value.IsNull()) return "~";
  std::string entries;
  for (const auto& entry : value) {
    if (!entries.empty()) entries += ", ";
    entries += value.IsMap() ? entry.first.Scalar() + ": " + shown_value(entry.second)
                             : shown_value(entry);
  }
  return value.IsMap() ? "{" + entries + "}" : "[" + entries + "]";
}

}  // namespace

ConfigReader::ConfigReader(std::shared_ptr<Node> node) : node_(std::move(node)) {}

ConfigReader ConfigReader::from_file(const std::filesystem::path& file) {
  return from_text(read_input_file(file), file.string());
}

ConfigReader ConfigReader::from_text(std::string_view text, std::string name) {
  auto node = std::make_shared<Node>();
  node->yaml = parse_mapping(std::string(text), name);
  node->file = std::move(name);
  return ConfigReader(std::move(node));
}

void ConfigReader::reject(std::string_view key, std::string_view rule) const {
  std::string shown;
  YAML::Mark mark = node_->yaml.Mark();
  for (const auto& entry : node_->yaml) {
    if (entry.first.Scalar() != key) continue;
    mark = entry.first.Mark();  // an absent value has the place of whatever comes next
    shown = " = " + shown_value(entry.second) + ", but";
  }
  throw ConfigError(at_line(node_->file, mark) + ": " + node_->path + std::string(key) + shown +
                    " " + std::string(rule));
}

bool ConfigReader::has(std::string_view key) const {
  return std::as_const(node_->yaml)[std::string(key)].IsDefined();
}

namespace {

/// The value of a key as T, or nothing if its type is another.
template <typename T>
std::optional<T> scalar(const YAML::Node& value) {
  T result{};
  if (!value.IsScalar() || !YAML::convert<T>::decode(value, result)) return std::nullopt;
  return result;
}

}  // namespace

double ConfigReader::number(std::string_view key, Range range) const {
  node_->read.emplace(key);
  const YAML::Node value = std::as_const(node_->yaml)[std::string(key)];
  if (!value.IsDefined()) reject(key, "is missing");
  const std::optional<double> number = scalar<double>(value);
  if (!number) reject(key, "must be a number");
  if (!std::isfinite(*number)) reject(key, "must be finite");
  if (!inside(*number, range)) reject(key, "must satisfy " + describe(range));
  return *number;
}

double ConfigReader::number_or(std::string_view key, double fallback, Range range) const {
  return has(key) ? number(key, range) : fallback;
}

int ConfigReader::integer(std::string_view key, int lowest, int highest) const {
  node_->read.emplace(key);
  const YAML::Node value = std::as_const(node_->yaml)[std::string(key)];
  if (!value.IsDefined()) reject(key, "is missing");
  const std::optional<int> number = scalar<int>(value);
  if (!number) reject(key, "must be a whole number");
  if (*number < lowest || *number > highest) {
    reject(key, "must satisfy " + std::to_string(lowest) + " <= x <= " + std::to_string(highest));
  }
  return *number;
}

int ConfigReader::integer_or(std::string_view key, int fallback, int lowest, int highest) const {
  return has(key) ? integer(key, lowest, highest) : fallback;
}

bool ConfigReader::flag(std::string_view key) const {
  node_->read.emplace(key);
  const YAML::Node value = std::as_const(node_->yaml)[std::string(key)];
  if (!value.IsDefined()) reject(key, "is missing");
  const std::optional<bool> flag = scalar<bool>(value);
  if (!flag) reject(key, "must be true or false");
  return *flag;
}

std::string ConfigReader::text(std::string_view key) const {
  node_->read.emplace(key);
  const YAML::Node value = std::as_const(node_->yaml)[std::string(key)];
  if (!value.IsDefined()) reject(key, "is missing");
  if (!value.IsScalar() || value.Scalar().empty()) reject(key, "must be a text");
  return value.Scalar();
}

std::string ConfigReader::text_or(std::string_view key, std::string fallback) const {
  return has(key) ? text(key) : std::move(fallback);
}

int ConfigReader::choice(std::string_view key, const std::vector<std::string>& choices) const {
  const std::string chosen = text(key);
  std::string rule = "must be one of";
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i] == chosen) return static_cast<int>(i);
    rule += (i == 0 ? " " : ", ") + choices[i];
  }
  reject(key, rule);
}

std::vector<double> ConfigReader::number_list(std::string_view key, Range range) const {
  node_->read.emplace(key);
  const YAML::Node value = std::as_const(node_->yaml)[std::string(key)];
  if (!value.IsDefined()) reject(key, "is missing");
  if (!value.IsSequence() || value.size() == 0) reject(key, "must be a list of numbers");
  std::vector<double> result;
  for (const YAML::Node& item : value) {
    const std::optional<double> number = scalar<double>(item);
    if (!number || !std::isfinite(*number)) reject(key, "must be a list of finite numbers");
    if (!inside(*number, range)) reject(key, "must satisfy " + describe(range) + " in each entry");
    result.push_back(*number);
  }
  return result;
}

Eigen::VectorXd ConfigReader::numbers(std::string_view key, int size, Range range) const {
  const std::vector<double> list = number_list(key, range);
  if (list.size() != static_cast<std::size_t>(size)) {
    reject(key, "must be a list of " + std::to_string(size) + " numbers");
  }
  return Eigen::Map<const Eigen::VectorXd>(list.data(), size);
}

ConfigReader ConfigReader::section(std::string_view key) const {
  node_->read.emplace(key);
  const YAML::Node value = std::as_const(node_->yaml)[std::string(key)];
  if (!value.IsDefined()) reject(key, "is missing");
  if (!value.IsMap()) reject(key, "must be a mapping");
  auto node = std::make_shared<Node>();
  node->yaml = value;
  node->file = node_->file;
  node->path = node_->path + std::string(key) + ".";
  return ConfigReader(std::move(node));
}

std::optional<ConfigReader> ConfigReader::section_if(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return section(key);
}

std::vector<ConfigReader> ConfigReader::list(std::string_view key) const {
  node_->read.emplace(key);
  const YAML::Node value = std::as_const(node_->yaml)[std::string(key)];
  if (!value.IsDefined()) reject(key, "is missing");
  if (!value.IsSequence()) reject(key, "must be a list of mappings");
  std::vector<ConfigReader> result;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!value[i].IsMap()) reject(key, "must be a list of mappings");
    auto node = std::make_shared<Node>();
    node->yaml = value[i];
    node->file = node_->file;
    node->path = node_->path + std::string(key) + "[" + std::to_string(i) + "].";
    result.push_back(ConfigReader(std::move(node)));
  }
  return result;
}

std::vector<ConfigReader> ConfigReader::list_if(std::string_view key) const {
  if (!has(key)) return {};
  return list(key);
}

std::vector<std::string> ConfigReader::keys() const {
  std::vector<std::string> result;
  for (const auto& entry : node_->yaml) result.push_back(entry.first.Scalar());
  return result;
}

void ConfigReader::finish() const {
  for (const auto& entry : node_->yaml) {
    const std::string& key = entry.first.Scalar();
    if (!node_->read.contains(key)) {
      throw ConfigError(at_line(node_->file, entry.first.Mark()) + ": " + node_->path + key +
                        " is not a known key here");
    }
  }
}

std::string ConfigReader::place() const {
  return at_line(node_->file, node_->yaml.Mark());
}

ConfigValue value_at(std::string_view text, const std::vector<std::string>& path) {
  YAML::Node node = parse_mapping(std::string(text), "text");
  for (const std::string& key : path) {
    if (!node.IsMap()) return {};
    node.reset(std::as_const(node)[key]);  // assignment would write into the tree
    if (!node.IsDefined()) return {};
  }
  if (node.IsMap()) return {.shape = ConfigShape::mapping, .words = {}};
  if (!node.IsSequence()) return {.shape = ConfigShape::scalar, .words = {}};
  ConfigValue value{.shape = ConfigShape::list, .words = {}};
  for (const YAML::Node& item : node) {
    value.words.push_back(item.IsScalar() ? item.Scalar() : std::string());
  }
  return value;
}

}  // namespace hopscotch::core
