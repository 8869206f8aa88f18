#include "perception/cloud_columns.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <utility>

namespace hopscotch::perception {

namespace {

constexpr std::size_t kCountMax = std::size_t{1} << 32U;
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

}  // namespace

std::optional<std::array<std::size_t, 3>> find_xyz(std::span<const CloudColumn> columns) {
  std::array<std::size_t, 3> places{};
  constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
  for (std::size_t axis = 0; axis < kNames.size(); ++axis) {
    const auto named = [&](const CloudColumn& column) { return column.name == kNames[axis]; };
    const auto found = std::find_if(columns.begin(), columns.end(), named);
    if (found == columns.end() || std::count_if(columns.begin(), columns.end(), named) > 1) {
      return std::nullopt;
    }
    const bool real = found->kind == NumberKind::real && (found->size == 4 || found->size == 8);
    if (!real || found->count != 1) return std::nullopt;
    places[axis] = static_cast<std::size_t>(found - columns.begin());
  }
  return places;
}

float number_at(const CloudColumn& column, ByteOrder order, const char* number) {
  std::array<char, 8> bytes{};
  std::memcpy(bytes.data(), number, column.size);
  const bool swapped = (order == ByteOrder::big) != (std::endian::native == std::endian::big);
  const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(column.size);
  if (swapped) std::reverse(bytes.begin(), end);
  if (column.size == 8) return static_cast<float>(std::bit_cast<double>(bytes));
  float value = 0.0F;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

float number_of(std::string_view word) {
  float value = 0.0F;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size() ? value : kNotANumber;
}

std::string_view next_word(std::string_view& line) {
  while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
  const auto end = std::find_if(line.begin(), line.end(), is_space);
  const std::string_view word = line.substr(0, static_cast<std::size_t>(end - line.begin()));
  line.remove_prefix(word.size());
  return word;
}

std::optional<std::string_view> next_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::optional<std::size_t> count_of(std::string_view word) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc{} && end == word.data() + word.size();
  return whole && value <= kCountMax ? std::optional(value) : std::nullopt;
}

std::optional<std::vector<Eigen::Vector3f>> read_text_rows(std::span<const CloudColumn> columns,
                                                           std::size_t rows,
                                                           std::string_view text) {
  const auto xyz = find_xyz(columns);
  if (!xyz) return std::nullopt;
  std::vector<Eigen::Vector3f> points;
  while (points.size() < rows) {
    std::optional<std::string_view> line = next_line(text);
    if (!line && !text.empty()) line = std::exchange(text, {});  // the last one may lack its end
    if (!line) return std::nullopt;
    Eigen::Vector3f p = Eigen::Vector3f::Constant(kNotANumber);
    for (std::size_t column = 0; column < columns.size(); ++column) {
      for (std::size_t i = 0; i < columns[column].count; ++i) {
        const std::string_view word = next_word(*line);
        if (word.empty()) return std::nullopt;
        const auto axis = std::find(xyz->begin(), xyz->end(), column);
        if (axis != xyz->end()) p(axis - xyz->begin()) = number_of(word);
      }
    }
    points.push_back(p);
  }
  return points;
}

}  // namespace hopscotch::perception
