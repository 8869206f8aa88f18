#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

/// Texts made from the command line's own definition, so that they cannot disagree with it.
namespace hopscotch::apps {

/// A man page in troff, section 1.
[[nodiscard]] std::string man_page(const CLI::App& app, std::string_view version);

/// A completion function for bash, which zsh takes with bashcompinit.
[[nodiscard]] std::string bash_completion(const CLI::App& app);

}  // namespace hopscotch::apps
