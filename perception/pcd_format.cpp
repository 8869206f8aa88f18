#include "perception/pcd_format.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "perception/cloud_columns.hpp"
#include "perception/lzf.hpp"

namespace hopscotch::perception {

namespace {

constexpr std::size_t kPointsMax = 20'000'000;
constexpr std::size_t kRowMax = 4096;  // [byte]

struct Header {
  std::vector<CloudColumn> columns;
  std::size_t row = 0;  ///< [byte]
  std::size_t width = 0;
  std::size_t height = 0;
  std::string_view encoding;

  [[nodiscard]] std::size_t points() const { return width * height; }
};

std::size_t count_in(const std::map<std::string_view, std::string_view>& lines, const char* key) {
  std::string_view rest = lines.at(key);
  const std::string word(next_word(rest));
  const std::optional<std::size_t> count = count_of(word);
  if (!count)
    throw MalformedCloud(std::string("header key ") + key + " = '" + word + "' is no count");
  return *count;
}

NumberKind kind_of(std::string_view word) {
  if (word == "F") return NumberKind::real;
  if (word == "I") return NumberKind::whole;
  if (word == "U") return NumberKind::natural;
  throw MalformedCloud("header key TYPE names '" + std::string(word) + "', not I, U or F");
}

std::vector<CloudColumn> columns_of(const std::map<std::string_view, std::string_view>& lines) {
  std::string_view names = lines.at("FIELDS");
  std::string_view sizes = lines.at("SIZE");
  std::string_view types = lines.at("TYPE");
  std::string_view counts = lines.contains("COUNT") ? lines.at("COUNT") : std::string_view{};
  std::vector<CloudColumn> columns;
  std::size_t offset = 0;
  for (std::string_view name = next_word(names); !name.empty(); name = next_word(names)) {
    const std::optional<std::size_t> size = count_of(next_word(sizes));
    const bool sound = size && (*size == 1 || *size == 2 || *size == 4 || *size == 8);
    if (!sound) throw MalformedCloud("header key SIZE does not give 1, 2, 4 or 8 for each field");
    CloudColumn column{.name = std::string(name), .kind = kind_of(next_word(types)), .size = *size};
    if (const std::string_view word = next_word(counts); !word.empty()) {
      const std::optional<std::size_t> count = count_of(word);
      if (!count || *count > kRowMax) throw MalformedCloud("header key COUNT holds no small count");
      column.count = *count;
    }
    column.offset = offset;
    offset += column.bytes();
    if (offset > kRowMax) throw MalformedCloud("the fields of a point are absurdly large");
    columns.push_back(column);
  }
  return columns;
}

/// Takes the header off the bytes.
Header take_header(std::string_view& bytes) {
  std::map<std::string_view, std::string_view> lines;
  while (!lines.contains("DATA")) {
    std::optional<std::string_view> line = next_line(bytes);
    if (!line) throw MalformedCloud("is no PCD: it has no DATA line");
    const std::string_view key = next_word(*line);
    if (!key.empty() && key.front() != '#') lines[key] = *line;
  }
  for (const char* key : {"FIELDS", "SIZE", "TYPE", "WIDTH", "HEIGHT"}) {
    if (!lines.contains(key)) throw MalformedCloud(std::string("the PCD header has no ") + key);
  }
  Header header{.columns = columns_of(lines),
                .row = 0,
                .width = count_in(lines, "WIDTH"),
                .height = count_in(lines, "HEIGHT"),
                .encoding = {}};
  for (const CloudColumn& column : header.columns) header.row += column.bytes();
  std::string_view data = lines.at("DATA");
  header.encoding = next_word(data);
  if (header.width > kPointsMax || header.height > kPointsMax || header.points() > kPointsMax) {
    throw MalformedCloud("promises " + std::to_string(header.width) + "x" +
                         std::to_string(header.height) + " points; at most " +
                         std::to_string(kPointsMax) + " are read");
  }
  if (header.points() == 0) throw MalformedCloud("holds no point");
  const bool stated = lines.contains("POINTS");
  if (stated && count_in(lines, "POINTS") != header.points()) {
    throw MalformedCloud("POINTS is not WIDTH times HEIGHT");
  }
  if (!find_xyz(header.columns)) throw MalformedCloud("has no fields x, y, z of real numbers");
  return header;
}

/// @param row  Bytes from one point to the next, or 0 when the columns lie one after the other.
std::vector<Eigen::Vector3f> read_points(const Header& header, std::string_view data,
                                         std::size_t row) {
  const std::array<std::size_t, 3> xyz = find_xyz(header.columns).value();
  std::vector<Eigen::Vector3f> points(header.points());
  for (std::size_t axis = 0; axis < xyz.size(); ++axis) {
    const CloudColumn& column = header.columns[xyz[axis]];
    const std::size_t start = row > 0 ? column.offset : header.points() * column.offset;
    const std::size_t step = row > 0 ? row : column.bytes();
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i](static_cast<Eigen::Index>(axis)) =
          number_at(column, ByteOrder::little, data.data() + start + i * step);
    }
  }
  return points;
}

std::vector<Eigen::Vector3f> read_binary(const Header& header, std::string_view data) {
  if (data.size() < header.points() * header.row) {
    throw MalformedCloud("is cut short: the header promises " + std::to_string(header.points()) +
                         " points of " + std::to_string(header.row) + " bytes, there are " +
                         std::to_string(data.size()) + " bytes");
  }
  return read_points(header, data, header.row);
}

std::size_t little_word(std::string_view data) {
  std::size_t value = 0;
  for (std::size_t i = 4; i > 0; --i) value = 256 * value + static_cast<std::uint8_t>(data[i - 1]);
  return value;
}

std::vector<Eigen::Vector3f> read_compressed(const Header& header, std::string_view data) {
  constexpr std::size_t kSizes = 8;
  constexpr std::size_t kRatioMax = 300;  // the format cannot pack denser
  if (data.size() < kSizes) throw MalformedCloud("is cut short: its compressed data are missing");
  const std::size_t packed = little_word(data);
  const std::size_t whole = little_word(data.substr(4));
  data.remove_prefix(kSizes);
  if (data.size() < packed) throw MalformedCloud("is cut short: its compressed data end too early");
  if (whole != header.points() * header.row || whole > kRatioMax * packed) {
    throw MalformedCloud("its compressed data are not of the size that the header promises");
  }
  const std::optional<std::string> unpacked = unpack_lzf(data.substr(0, packed), whole);
  if (!unpacked) throw MalformedCloud("its compressed data are damaged");
  return read_points(header, *unpacked, 0);
}

std::vector<Eigen::Vector3f> read_text(const Header& header, std::string_view data) {
  if (data.size() < 2 * header.points()) throw MalformedCloud("is cut short");
  auto points = read_text_rows(header.columns, header.points(), data);
  if (!points) throw MalformedCloud("is cut short, or a line holds fewer numbers than fields");
  return *std::move(points);
}

}  // namespace

PointCloud read_pcd(std::string_view bytes) {
  const Header header = take_header(bytes);
  PointCloud cloud{.width = static_cast<int>(header.width),
                   .height = static_cast<int>(header.height),
                   .points = {}};
  if (header.encoding == "ascii") {
    cloud.points = read_text(header, bytes);
  } else if (header.encoding == "binary") {
    cloud.points = read_binary(header, bytes);
  } else if (header.encoding == "binary_compressed") {
    cloud.points = read_compressed(header, bytes);
  } else {
    throw MalformedCloud("DATA is '" + std::string(header.encoding) +
                         "', not ascii, binary or binary_compressed");
  }
  return cloud;
}

}  // namespace hopscotch::perception
