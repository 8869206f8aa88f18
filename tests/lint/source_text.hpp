#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hopscotch::lint {

/// One file of the tree.
struct SourceFile {
  std::string path;  ///< From the root, with '/'.
  std::string text;
};

/// The text with the contents of comments, strings and character literals blanked out. Lines and
/// columns stay.
[[nodiscard]] std::string code_only(std::string_view text);

[[nodiscard]] std::vector<std::string> split_lines(std::string_view text);

/// A `#include` line.
struct Include {
  int line = 0;  ///< From 1.
  std::string name;
};
[[nodiscard]] std::vector<Include> includes_of(const SourceFile& file);

/// A function with a body. Found by its shape, not by parsing C++: a head that ends in a parameter
/// list and qualifiers, followed by '{'.
struct Function {
  int first_line = 0;  ///< Of the opening brace, from 1.
  int last_line = 0;   ///< Of the closing brace.
  std::vector<std::string> parameters;
};
[[nodiscard]] std::vector<Function> functions_of(std::string_view code);

/// Whether `word` stands in `code` and is no part of a longer identifier.
[[nodiscard]] bool has_word(std::string_view code, std::string_view word);

}  // namespace hopscotch::lint
