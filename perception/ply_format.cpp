#include "perception/ply_format.hpp"

#include <array>
#include <string>
#include <vector>

#include "perception/cloud_columns.hpp"

namespace hopscotch::perception {

namespace {

constexpr std::size_t kPointsMax = 20'000'000;
constexpr std::size_t kRowMax = 4096;  // [byte]

struct Element {
  std::string name;
  std::size_t rows = 0;
  std::size_t row = 0;  ///< [byte]
  std::vector<CloudColumn> columns;
  bool has_list = false;  ///< Its rows differ in length.
};

struct Header {
  std::string encoding;
  std::vector<Element> elements;
};

struct PlyType {
  std::string_view name;
  NumberKind kind;
  std::size_t size;
};

constexpr std::array<PlyType, 16> kTypes{{{"char", NumberKind::whole, 1},
                                          {"int8", NumberKind::whole, 1},
                                          {"uchar", NumberKind::natural, 1},
                                          {"uint8", NumberKind::natural, 1},
                                          {"short", NumberKind::whole, 2},
                                          {"int16", NumberKind::whole, 2},
                                          {"ushort", NumberKind::natural, 2},
                                          {"uint16", NumberKind::natural, 2},
                                          {"int", NumberKind::whole, 4},
                                          {"int32", NumberKind::whole, 4},
                                          {"uint", NumberKind::natural, 4},
                                          {"uint32", NumberKind::natural, 4},
                                          {"float", NumberKind::real, 4},
                                          {"float32", NumberKind::real, 4},
                                          {"double", NumberKind::real, 8},
                                          {"float64", NumberKind::real, 8}}};

const PlyType& type_of(std::string_view word) {
  for (const PlyType& type : kTypes) {
    if (type.name == word) return type;
  }
  throw MalformedCloud("unknown PLY type '" + std::string(word) + "'");
}

void add_property(std::string_view line, Element& element) {
  const std::string_view type = next_word(line);
  if (type == "list") {
    element.has_list = true;
    return;
  }
  const PlyType& number = type_of(type);
  element.columns.push_back({.name = std::string(next_word(line)),
                             .kind = number.kind,
                             .size = number.size,
                             .offset = element.row});
  element.row += number.size;
  if (element.row > kRowMax) throw MalformedCloud("the properties of a point are absurdly large");
}

/// Takes the header off the bytes.
Header take_header(std::string_view& bytes) {
  Header header;
  for (;;) {
    std::optional<std::string_view> line = next_line(bytes);
    if (!line) throw MalformedCloud("the PLY header does not end");
    const std::string_view key = next_word(*line);
    if (key == "end_header") return header;
    if (key == "format") header.encoding = next_word(*line);
    if (key == "element") {
      Element element{.name = std::string(next_word(*line)), .columns = {}};
      const std::optional<std::size_t> rows = count_of(next_word(*line));
      if (!rows) throw MalformedCloud("the PLY header gives element " + element.name + " no count");
      element.rows = *rows;
      header.elements.push_back(std::move(element));
    }
    if (key == "property" && header.elements.empty()) {
      throw MalformedCloud("the PLY header has a property before any element");
    }
    if (key == "property") add_property(*line, header.elements.back());
  }
}

/// Passes over the rows of an element of text.
void skip_text(const Element& element, std::string_view& bytes) {
  for (std::size_t i = 0; i < element.rows; ++i) {
    if (!next_line(bytes)) throw MalformedCloud("is cut short");
  }
}

void skip_binary(const Element& element, std::string_view& bytes) {
  if (element.has_list) {
    throw MalformedCloud("element " + element.name + " with lists comes before the vertices");
  }
  const bool fits = element.row == 0 || element.rows <= bytes.size() / element.row;
  if (!fits) throw MalformedCloud("is cut short");
  bytes.remove_prefix(element.rows * element.row);
}

std::vector<Eigen::Vector3f> read_binary(const Element& vertices, ByteOrder order,
                                         std::string_view data) {
  if (data.size() / vertices.row < vertices.rows) {
    throw MalformedCloud("is cut short: the header promises " + std::to_string(vertices.rows) +
                         " points, there are " + std::to_string(data.size()) + " bytes of data");
  }
  const std::array<std::size_t, 3> xyz = find_xyz(vertices.columns).value();
  std::vector<Eigen::Vector3f> points(vertices.rows);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < xyz.size(); ++axis) {
      const CloudColumn& column = vertices.columns[xyz[axis]];
      points[i](static_cast<Eigen::Index>(axis)) =
          number_at(column, order, data.data() + i * vertices.row + column.offset);
    }
  }
  return points;
}

std::vector<Eigen::Vector3f> read_rows(const Element& vertices, const std::string& encoding,
                                       std::string_view data) {
  if (encoding == "binary_little_endian") return read_binary(vertices, ByteOrder::little, data);
  if (encoding == "binary_big_endian") return read_binary(vertices, ByteOrder::big, data);
  if (data.size() < 2 * vertices.rows) throw MalformedCloud("is cut short");
  auto points = read_text_rows(vertices.columns, vertices.rows, data);
  if (!points) throw MalformedCloud("is cut short, or a line holds fewer numbers than properties");
  return *std::move(points);
}

void check(const Element& vertices) {
  if (vertices.rows == 0) throw MalformedCloud("holds no point");
  if (vertices.rows > kPointsMax) {
    throw MalformedCloud("promises " + std::to_string(vertices.rows) + " points; at most " +
                         std::to_string(kPointsMax) + " are read");
  }
  if (vertices.has_list) throw MalformedCloud("its vertices hold lists");
  if (!find_xyz(vertices.columns)) throw MalformedCloud("has no x, y, z of real numbers");
}

}  // namespace

PointCloud read_ply(std::string_view bytes) {
  const Header header = take_header(bytes);
  const bool text = header.encoding == "ascii";
  const bool known =
      text || header.encoding == "binary_little_endian" || header.encoding == "binary_big_endian";
  if (!known) throw MalformedCloud("PLY format '" + header.encoding + "' is unknown");
  for (const Element& element : header.elements) {
    if (element.name == "vertex") {
      check(element);
      return {.width = static_cast<int>(element.rows),
              .height = 1,
              .points = read_rows(element, header.encoding, bytes)};
    }
    if (text) {
      skip_text(element, bytes);
    } else {
      skip_binary(element, bytes);
    }
  }
  throw MalformedCloud("has no element vertex");
}

}  // namespace hopscotch::perception
