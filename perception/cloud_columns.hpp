#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What the two formats of point clouds share: named columns of numbers.
namespace hopscotch::perception {

enum class NumberKind : std::uint8_t { whole, natural, real };

/// One column of a table of points.
struct CloudColumn {
  std::string name;
  NumberKind kind = NumberKind::real;
  std::size_t size = 0;    ///< Of one number: 1, 2, 4 or 8 [byte].
  std::size_t count = 1;   ///< Numbers of this name in a row.
  std::size_t offset = 0;  ///< Of the first one from the start of a row [byte].

  [[nodiscard]] std::size_t bytes() const { return size * count; }
};

enum class ByteOrder : std::uint8_t { little, big };

/// Places of x, y and z among columns; nothing unless all three are there once, as real numbers.
[[nodiscard]] std::optional<std::array<std::size_t, 3>> find_xyz(
    std::span<const CloudColumn> columns);

/// Of one row of binary data. @pre the row holds the whole column.
[[nodiscard]] float number_at(const CloudColumn& column, ByteOrder order, const char* number);

/// One word of text; not a number when it is none.
[[nodiscard]] float number_of(std::string_view word);

/// Takes the next word off a line; empty at its end.
[[nodiscard]] std::string_view next_word(std::string_view& line);

/// Takes the next line off a text, without its end; nothing when there is no whole line left.
[[nodiscard]] std::optional<std::string_view> next_line(std::string_view& text);

/// A count in a header; nothing when the word is none, or larger than any file's.
[[nodiscard]] std::optional<std::size_t> count_of(std::string_view word);

/// Rows of text, each with all columns. @return nothing when the text ends before the last row or
/// a row is too short.
[[nodiscard]] std::optional<std::vector<Eigen::Vector3f>> read_text_rows(
    std::span<const CloudColumn> columns, std::size_t rows, std::string_view text);

}  // namespace hopscotch::perception
