#include "tests/lint/source_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace hopscotch::lint {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::string_view trim(std::string_view text) {
  const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Where the literal or comment that starts at `begin` ends (one past it); `begin` if none starts.
std::size_t end_of_blank(std::string_view text, std::size_t begin) {
  const auto past = [&](std::string_view mark, std::size_t from) {
    const std::size_t at = text.find(mark, from);
    return at == std::string_view::npos ? text.size() : at + mark.size();
  };
  const std::string_view rest = text.substr(begin);
  if (rest.starts_with("//")) return std::min(text.find('\n', begin), text.size());
  if (rest.starts_with("/*")) return past("*/", begin + 2);
  if (rest.starts_with("R\"")) {
    const std::size_t open = text.find('(', begin);
    if (open == std::string_view::npos) return text.size();
    std::string mark(")");
    mark.append(text.substr(begin + 2, open - begin - 2)).append("\"");
    return past(mark, open);
  }
  const bool is_digit_separator = rest.front() == '\'' && begin > 0 && is_word(text[begin - 1]);
  if ((rest.front() != '"' && rest.front() != '\'') || is_digit_separator) return begin;
  std::size_t i = begin + 1;
  while (i < text.size() && text[i] != rest.front() && text[i] != '\n') {
    i += text[i] == '\\' ? 2U : 1U;
  }
  return std::min(i + 1, text.size());
}

/// Position of the bracket that closes the one at `open`.
std::optional<std::size_t> closing(std::string_view code, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < code.size(); ++i) {
    if (code[i] == '(' || code[i] == '{') ++depth;
    if ((code[i] == ')' || code[i] == '}') && --depth == 0) return i;
  }
  return std::nullopt;
}

std::vector<std::string> split_parameters(std::string_view list) {
  std::vector<std::string> result;
  int depth = 0;
  std::string current;
  for (const char c : list) {
    if (c == '(' || c == '<' || c == '{' || c == '[') ++depth;
    if (c == ')' || c == '>' || c == '}' || c == ']') --depth;
    if (c == ',' && depth == 0) {
      result.emplace_back(trim(current));
      current.clear();
    } else {
      current += c;
    }
  }
  if (!trim(current).empty()) result.emplace_back(trim(current));
  return result;
}

/// Text between a statement's end and an opening brace, taken apart as a function's head.
struct Head {
  std::vector<std::string> parameters;
  bool in_member_list = false;  ///< Behind the ':' of a constructor.
};

std::optional<Head> function_head(std::string_view text) {
  constexpr std::array<std::string_view, 13> kNoFunction{
      "if",    "for",    "while", "switch", "catch",  "else",  "do",
      "class", "struct", "enum",  "union",  "extern", "return"};
  if (text.starts_with("template")) {
    const std::size_t body = text.find("> ");
    if (body != std::string_view::npos) text.remove_prefix(body + 1);
  }
  std::size_t open = text.find('(');
  if (open == std::string_view::npos) return std::nullopt;
  if (text.substr(0, open).ends_with("operator")) open = text.find('(', open + 1);
  if (open == std::string_view::npos) return std::nullopt;
  const std::string_view before = text.substr(0, open);
  const bool is_call = before.find('=') != std::string_view::npos &&
                       before.find("operator") == std::string_view::npos;
  if (trim(before).empty() || is_call) return std::nullopt;
  for (const std::string_view word : kNoFunction) {
    if (has_word(before, word)) return std::nullopt;
  }
  const std::optional<std::size_t> close = closing(text, open);
  if (!close) return std::nullopt;
  Head head{.parameters = split_parameters(text.substr(open + 1, *close - open - 1))};
  const std::string_view after = trim(text.substr(*close + 1));
  head.in_member_list = after.starts_with(':');
  return head;
}

/// Walks through code brace by brace. `pending_` is what stands between the last statement and
/// here.
class FunctionScanner {
 public:
  explicit FunctionScanner(std::string_view code) : code_(code) {}

  std::vector<Function> run() {
    for (; at_ < code_.size(); ++at_) {
      const char c = code_[at_];
      if (c == '#' && trim(pending_).empty()) skip_preprocessor_line();
      if (at_ < code_.size() && code_[at_] == '\n') ++line_;
      if (c == '{') {
        open_brace();
      } else if (c == '}') {
        close_brace();
      } else if (c == ';') {
        pending_.clear();
      } else if (c != '#') {
        pending_ += c;
      }
    }
    return std::move(found_);
  }

 private:
  void skip_preprocessor_line() {
    while (at_ < code_.size() && (code_[at_] != '\n' || code_[at_ - 1] == '\\')) {
      if (code_[at_] == '\n') ++line_;
      ++at_;
    }
  }

  void open_brace() {
    const std::optional<Head> head =
        functions_around_ == 0 ? function_head(trim(pending_)) : std::nullopt;
    if (head && head->in_member_list && is_word(trim(pending_).back())) {
      skip_member_value();
      return;
    }
    if (head) {
      found_.push_back({.first_line = line_, .last_line = line_, .parameters = head->parameters});
      ++functions_around_;
    }
    is_function_.push_back(head.has_value());
    pending_.clear();
  }

  /// Over `{value}` of a constructor's member list.
  void skip_member_value() {
    const std::size_t end = closing(code_, at_).value_or(code_.size() - 1);
    const std::string_view value = code_.substr(at_, end - at_);
    line_ += static_cast<int>(std::count(value.begin(), value.end(), '\n'));
    pending_ += "()";
    at_ = end;
  }

  void close_brace() {
    if (!is_function_.empty()) {
      if (is_function_.back()) {
        --functions_around_;
        found_.back().last_line = line_;
      }
      is_function_.pop_back();
    }
    pending_.clear();
  }

  std::string_view code_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::string pending_;
  std::vector<bool> is_function_;  // for each open brace
  int functions_around_ = 0;
  std::vector<Function> found_;
};

}  // namespace

std::string code_only(std::string_view text) {
  std::string result(text);
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = end_of_blank(text, i);
    if (end == i) {
      ++i;
      continue;
    }
    for (; i < end; ++i) {
      if (text[i] != '\n') result[i] = ' ';
    }
  }
  return result;
}

std::vector<std::string> split_lines(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::vector<Include> includes_of(const SourceFile& file) {
  const std::vector<std::string> raw = split_lines(file.text);
  const std::vector<std::string> code = split_lines(code_only(file.text));
  std::vector<Include> result;
  for (std::size_t i = 0; i < code.size(); ++i) {
    // The code decides that this is an include, the raw line still has the quoted name.
    if (!trim(code[i]).starts_with("#include")) continue;
    const std::size_t open = raw[i].find_first_of("<\"");
    if (open == std::string::npos) continue;
    const std::size_t close = raw[i].find_first_of(">\"", open + 1);
    if (close == std::string::npos) continue;
    result.push_back({static_cast<int>(i) + 1, raw[i].substr(open + 1, close - open - 1)});
  }
  return result;
}

std::vector<Function> functions_of(std::string_view code) {
  return FunctionScanner(code).run();
}

bool has_word(std::string_view code, std::string_view word) {
  for (std::size_t at = code.find(word); at != std::string_view::npos;
       at = code.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool starts = at == 0 || !is_word(code[at - 1]);
    const bool ends = end == code.size() || !is_word(code[end]);
    if (starts && ends) return true;
  }
  return false;
}

}  // namespace hopscotch::lint
